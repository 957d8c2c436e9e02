#include "search_work.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace downwash::bench {
namespace {

/// Solves a symmetric system by Gauss' elimination; columns without a pivot give 0.
std::array<double, 3> solved(std::array<std::array<double, 4>, 3> rows, const std::array<bool, 3>& is_used) {
    std::array<double, 3> x{};
    std::array<int, 3> row_of{-1, -1, -1};
    std::size_t next = 0;
    for (std::size_t column = 0; column < 3; ++column) {
        if (!is_used[column]) {
            continue;
        }
        std::size_t pivot = next;
        for (std::size_t i = next; i < 3; ++i) {
            pivot = std::abs(rows[i][column]) > std::abs(rows[pivot][column]) ? i : pivot;
        }
        if (next >= 3 || !(std::abs(rows[pivot][column]) > 0)) {
            continue;
        }
        std::swap(rows[next], rows[pivot]);
        for (std::size_t i = 0; i < 3; ++i) {
            if (i != next) {
                const double factor = rows[i][column] / rows[next][column];
                for (std::size_t k = 0; k < 4; ++k) {
                    rows[i][k] -= factor * rows[next][k];
                }
            }
        }
        row_of[column] = static_cast<int>(next++);
    }
    for (std::size_t column = 0; column < 3; ++column) {
        if (row_of[column] >= 0) {
            const auto& row = rows[static_cast<std::size_t>(row_of[column])];
            x[column] = row[3] / row[column];
        }
    }
    return x;
}

/// Ticks with few lanes, with many, and lanes summed over ticks.
std::array<double, 3> tick_counts(const WorkPiece& batch) {
    std::array<double, 3> counts{};
    for (std::size_t i = 0; i < batch.lane_ticks.size(); ++i) {
        const auto ticks = static_cast<double>(batch.lane_ticks[i]);
        counts[i < TickTime::few_lanes ? 0 : 1] += ticks;
        counts[2] += ticks * static_cast<double>(i + 1);
    }
    return counts;
}

double sum_s(const WorkChain& chain, bool of_flights) {
    double sum = 0;
    for (const WorkItem& item : chain) {
        sum += (item.kind == WorkItem::Kind::batch) == of_flights ? item.work_s : 0;
    }
    return sum;
}

void add_serial(WorkChain& chain, double work_s) {
    if (work_s > 0) {
        WorkItem item;
        item.work_s = work_s;
        chain.push_back(std::move(item));
    }
}

/// Makes items of pieces.
class Itemiser {
 public:
    explicit Itemiser(std::span<const WorkPiece> pieces) {
        std::map<int, std::vector<const WorkPiece*>> by_kind;
        for (const WorkPiece& piece : pieces) {
            if (piece.kind == WorkPiece::Kind::batch) {
                by_kind[kind_of(piece)].push_back(&piece);
            }
        }
        for (const auto& [kind, batches] : by_kind) {
            tick_times_[kind] = fitted_tick_time(batches);
        }
    }

    /// The pieces, and the serial work between them.
    [[nodiscard]] WorkChain chain(std::span<const WorkPiece* const> leaves, double begin_s, double end_s) const {
        WorkChain chain;
        double now_s = begin_s;
        for (const WorkPiece* leaf : leaves) {
            add_serial(chain, leaf->begin_s - now_s);
            chain.push_back(item(*leaf));
            now_s = leaf->end_s;
        }
        add_serial(chain, end_s - now_s);
        return chain;
    }

 private:
    static int kind_of(const WorkPiece& batch) { return (batch.is_in_worlds ? 1 : 0) + (batch.has_noise ? 2 : 0); }

    [[nodiscard]] WorkItem item(const WorkPiece& piece) const {
        WorkItem item;
        item.work_s = piece.end_s - piece.begin_s;
        if (piece.kind == WorkPiece::Kind::parallel) {
            item.kind = WorkItem::Kind::parallel;
            item.items = piece.items;
            return item;
        }
        item.tick = tick_times_.at(kind_of(piece));
        const double modelled_s = one_thread_time_s(piece.job_ticks, item.tick);
        if (!(modelled_s > 0)) {
            return item;  // nothing was flown: what it took is serial
        }
        item.kind = WorkItem::Kind::batch;
        item.ticks = piece.job_ticks;
        const double scale = item.work_s / modelled_s;
        item.tick = {scale * item.tick.few_s, scale * item.tick.many_s, scale * item.tick.lane_s};
        return item;
    }

    std::map<int, TickTime> tick_times_;
};

}  // namespace

TickTime fitted_tick_time(std::span<const WorkPiece* const> batches) {
    std::array<std::array<double, 4>, 3> normal{};
    for (const WorkPiece* batch : batches) {
        const std::array<double, 3> counts = tick_counts(*batch);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                normal[i][k] += counts[i] * counts[k];
            }
            normal[i][3] += counts[i] * (batch->end_s - batch->begin_s);
        }
    }
    // Of all sets of times the one without a negative time that fits best: with three, trying them all is simplest.
    std::array<double, 3> best{};
    double best_error = HUGE_VAL;
    for (unsigned set = 1; set < 8; ++set) {
        const std::array<bool, 3> is_used{(set & 1U) != 0, (set & 2U) != 0, (set & 4U) != 0};
        auto rows = normal;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                rows[i][k] = is_used[i] && is_used[k] ? rows[i][k] : 0;
            }
            rows[i][3] = is_used[i] ? rows[i][3] : 0;
        }
        const std::array<double, 3> x = solved(rows, is_used);
        double error = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            error -= 2 * x[i] * normal[i][3];
            for (std::size_t k = 0; k < 3; ++k) {
                error += x[i] * normal[i][k] * x[k];
            }
        }
        if (std::ranges::all_of(x, [](double value) { return value >= 0; }) && error < best_error) {
            best = x;
            best_error = error;
        }
    }
    // What was never seen takes as long as what was.
    const bool no_few = !(normal[0][0] > 0);
    const bool no_many = !(normal[1][1] > 0);
    return {no_few ? best[1] : best[0], no_many ? best[0] : best[1], best[2]};
}

double one_thread_time_s(std::span<const std::int64_t> job_ticks, const TickTime& tick) {
    std::vector<std::int64_t> lanes;
    std::size_t next = 0;
    double time_s = 0;
    for (;;) {
        while (lanes.size() < WorkPiece::max_lanes && next < job_ticks.size()) {
            if (const std::int64_t ticks = job_ticks[next++]; ticks > 0) {
                lanes.push_back(ticks);
            }
        }
        if (lanes.empty()) {
            return time_s;
        }
        const std::int64_t passed = *std::min_element(lanes.begin(), lanes.end());
        time_s += static_cast<double>(passed) * tick.at(static_cast<int>(lanes.size()));
        for (std::int64_t& left : lanes) {
            left -= passed;
        }
        std::erase(lanes, 0);
    }
}

SearchWork search_work(std::span<const WorkPiece> pieces, double begin_s, double end_s) {
    const Itemiser itemiser(pieces);
    SearchWork work;
    std::vector<const WorkPiece*> leaves;  // that no step has yet
    WorkRound round;
    double now_s = begin_s;
    double round_begins_s = HUGE_VAL;  // with its first step
    std::vector<const WorkPiece*> outside;
    for (const WorkPiece& piece : pieces) {
        switch (piece.kind) {
            case WorkPiece::Kind::batch:
            case WorkPiece::Kind::parallel:
                leaves.push_back(&piece);
                break;
            case WorkPiece::Kind::step: {
                const auto first =
                    std::ranges::find_if(leaves, [&](const WorkPiece* leaf) { return leaf->begin_s >= piece.begin_s; });
                outside.insert(outside.end(), leaves.begin(), first);
                leaves.erase(leaves.begin(), first);
                round_begins_s = std::min(round_begins_s, piece.begin_s);
                round.tasks.at(static_cast<std::size_t>(piece.task))
                    .push_back(itemiser.chain(leaves, piece.begin_s, piece.end_s));
                leaves.clear();
                break;
            }
            case WorkPiece::Kind::round:
                work.stages.push_back(
                    {itemiser.chain(outside, now_s, std::min(round_begins_s, piece.end_s)), std::move(round)});
                outside.clear();
                round = {};
                round_begins_s = HUGE_VAL;
                now_s = piece.end_s;
                break;
        }
    }
    work.stages.push_back({itemiser.chain(leaves, now_s, end_s), {}});
    return work;
}

double WorkShares::all_s() const noexcept {
    double all = outside_serial_s + outside_flights_s;
    for (std::size_t i = 0; i < 3; ++i) {
        all += task_serial_s[i] + task_flights_s[i];
    }
    return all;
}

WorkShares shares_of(const SearchWork& work) {
    WorkShares shares;
    const auto count = [&](const WorkChain& chain) {
        for (const WorkItem& item : chain) {
            shares.batches += item.kind == WorkItem::Kind::batch ? 1 : 0;
            shares.jobs += item.ticks.size();
        }
    };
    for (const WorkStage& stage : work.stages) {
        shares.outside_serial_s += sum_s(stage.before, false);
        shares.outside_flights_s += sum_s(stage.before, true);
        count(stage.before);
        bool has_steps = false;
        for (std::size_t task = 0; task < 3; ++task) {
            for (const WorkChain& step : stage.round.tasks[task]) {
                shares.task_serial_s[task] += sum_s(step, false);
                shares.task_flights_s[task] += sum_s(step, true);
                count(step);
                ++shares.steps;
                has_steps = true;
            }
        }
        shares.rounds += has_steps ? 1 : 0;
    }
    return shares;
}

}  // namespace downwash::bench
