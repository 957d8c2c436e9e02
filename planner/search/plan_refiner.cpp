#include "downwash/search/plan_refiner.hpp"

#include <algorithm>
#include <utility>

namespace downwash::planning {
namespace {

constexpr int changes_side_by_side = 8;

/// How many batches are drawn at once: as many as have failed in a row, and one more, but no more than this.
constexpr std::size_t max_batches_ahead = 4;

/// Changes begin with the largest and shrink to this share of them.
constexpr double min_step = 0.01;

/// When so many batches in a row did not make a plan better its steps become large again.
constexpr int max_failures = 60;

/// After how many of its batches the other plan has to be nearly as cheap as the best, and after how many cheaper.
constexpr int batches_to_come_near = 60;
constexpr double near_cost_ratio = 1.05;
constexpr int batches_to_overtake = 180;

/// A plan is kept in its lineage when it has become cheaper by this share.
constexpr double lineage_step = 0.01;

/// In how many batches a plan that fails in counterexamples may be changed, and with which share of the largest steps.
constexpr int repair_batches = 6;
constexpr double repair_step = 0.3;
/// Shares of the goal's tolerance that its end may use up then.
constexpr double repair_shares[] = {0.6, 0.3, 0.0};

/// A plan so much dearer than the best is not worth working on.
constexpr double max_cost_ratio = 1.5;

}  // namespace

template <class Family>
PlanRefinerOf<Family>::PlanRefinerOf(FlightPoint start, PlannedFlights& flights, Random& random)
    : flights_(flights), random_(random), changes_(flights, random), change_flights_(std::move(start), flights) {}

template <class Family>
void PlanRefinerOf<Family>::Pace::succeed() noexcept {
    step = std::min(1.0, 1.5 * step);
    failures = 0;
}

template <class Family>
void PlanRefinerOf<Family>::Pace::fail() noexcept {
    step = std::max(min_step, 0.9 * step);
    if (++failures >= max_failures) {
        step = 1;
        failures = 0;
    }
}

template <class Family>
auto PlanRefinerOf<Family>::best() const noexcept -> const FlownPlan* {
    return tracks_.empty() ? nullptr : &tracks_.front().plan;
}

template <class Family>
void PlanRefinerOf<Family>::drop(int number) {
    std::erase_if(tracks_, [number](const Track& track) { return track.number == number; });
}

/// The cheapest of some changed plans that fly in all worlds, of the first batch that has any.
template <class Family>
auto PlanRefinerOf<Family>::repaired(const ChangedPlan& plan) -> std::optional<FlownPlan> {
    for (int batch = 0; batch < repair_batches; ++batch) {
        std::vector<ChangedPlan> changes;
        FlightStatistics counts;
        if (batch == 0) {
            for (const double share : repair_shares) {
                if (auto change = moved_into_goal(plan, share, counts)) {
                    changes.push_back(std::move(*change));
                }
            }
        }
        for (int tries = 0; tries < 4 * changes_side_by_side && changes.size() < changes_side_by_side; ++tries) {
            if (auto change = changed(plan.points, plan.ticks, repair_step, counts)) {
                changes.push_back(std::move(*change));
            }
        }
        flights_.add(counts);
        std::optional<FlownPlan> best;
        for (std::optional<FlownPlan>& flown : change_flights_.flown_whole(changes)) {
            if (flown && (!best || flown->cost < best->cost)) {
                best = std::move(flown);
            }
        }
        if (best) {
            return best;
        }
    }
    return std::nullopt;
}

template <class Family>
auto PlanRefinerOf<Family>::as_change(const Plan& plan) -> ChangedPlan {
    ChangedPlan change;
    for (std::size_t i = 0; i < plan.reference.size(); ++i) {
        change.points.push_back(plan.reference[i].point);
        if (i > 0) {
            change.ticks.push_back(plan.reference[i].tick - plan.reference[i - 1].tick);
        }
    }
    return change;
}

template <class Family>
void PlanRefinerOf<Family>::work_on(Lineage lineage, std::size_t steps_back) {
    if (lineage.back().reference.size() < 2) {
        return;  // the start meets the goal: there is nothing on the way
    }
    const ChangedPlan last = as_change(lineage.back());
    std::optional<FlownPlan> flown;
    if (steps_back == 0) {
        flown = std::move(change_flights_.flown_whole({last}).front());
    }
    if (!flown && flights_.has_counterexamples()) {
        lineage.resize(lineage.size() - std::clamp<std::size_t>(steps_back, 1, lineage.size()));
        flown = last_that_flies(lineage);
        std::optional<FlownPlan> changed = flown && steps_back > 1 ? std::nullopt : repaired(last);
        if (changed && (!flown || changed->cost < flown->cost)) {
            flown = std::move(changed);
            lineage.push_back(plan_of(*flown));
        }
    }
    if (flown) {
        add(std::move(*flown), std::move(lineage));
    }
}

/// Leaves out the end of a lineage up to the last plan that nothing rejects.
template <class Family>
auto PlanRefinerOf<Family>::last_that_flies(Lineage& lineage) -> std::optional<FlownPlan> {
    for (; !lineage.empty(); lineage.pop_back()) {
        if (std::optional<FlownPlan> flown =
                std::move(change_flights_.flown_whole({as_change(lineage.back())}).front())) {
            return flown;
        }
    }
    return std::nullopt;
}

template <class Family>
void PlanRefinerOf<Family>::add(FlownPlan plan, Lineage lineage) {
    const double cost = plan.cost;
    Track track{std::move(plan), ++versions_, std::move(lineage), cost, ++taken_};
    if (tracks_.empty() || track.plan.cost < tracks_.front().plan.cost) {
        if (!tracks_.empty()) {
            tracks_.front().batches = 0;  // it has its turns to overtake before it
        }
        tracks_.insert(tracks_.begin(), std::move(track));
        tracks_.resize(std::min(tracks_.size(), max_tracks));
    } else if (track.plan.cost < max_cost_ratio * tracks_.front().plan.cost && tracks_.size() < max_tracks) {
        tracks_.push_back(std::move(track));
    }
}

template <class Family>
auto PlanRefinerOf<Family>::plan_of(const FlownPlan& flown) const -> Plan {
    return plan_through(moments_of(flown), flights_.task().blank_plan);
}

template <class Family>
auto PlanRefinerOf<Family>::release() -> std::vector<Lineage> {
    std::vector<Lineage> lineages;
    for (Track& track : tracks_) {
        lineages.push_back(std::move(track.lineage));
        if (track.plan.cost < track.kept_cost) {
            lineages.back().push_back(plan_of(track.plan));
        }
    }
    tracks_.clear();
    return lineages;
}

template <class Family>
auto PlanRefinerOf<Family>::changed(const std::vector<ReferencePoint>& points, const std::vector<std::int64_t>& ticks,
                                    double step, FlightStatistics& counts) -> std::optional<ChangedPlan> {
    auto drawn = changes_.draw(points, ticks, step);
    return drawn ? change_flights_.timed(std::move(drawn->points), ticks, drawn->first_segment, drawn->last_segment,
                                         counts)
                 : std::nullopt;
}

template <class Family>
auto PlanRefinerOf<Family>::moved_into_goal(const ChangedPlan& plan, double share, FlightStatistics& counts) const
    -> std::optional<ChangedPlan> {
    const Configuration end = configuration_of(plan.points.back());
    const Configuration moved = flights_.goal().moved_into(end, share);
    if (moved == end) {
        return std::nullopt;
    }
    std::vector<ReferencePoint> points = plan.points;
    points.back() = flights_.task().space.looking(points[points.size() - 2], at_rest(moved));
    return change_flights_.timed(std::move(points), plan.ticks, plan.ticks.size() - 1, plan.ticks.size() - 1, counts);
}

/// Draws the next batch of changes, and where several fly at once those that follow if it fails. All are flown.
template <class Family>
void PlanRefinerOf<Family>::draw_batches() {
    const std::size_t wanted = flights_.can_fly_chains() ? std::min(failures_in_a_row_ + 1, max_batches_ahead) : 1;
    const Random now = random_;
    std::vector<Pace> paces;
    for (const Track& track : tracks_) {
        paces.push_back(track.pace);
    }
    std::vector<ChangeBatch*> drawn;
    std::vector<const FlownPlan*> bases;
    for (std::size_t ahead = 0; ahead < wanted; ++ahead) {
        const std::size_t turn = turn_ + ahead;
        const std::size_t number = turn % tracks_.size();
        const Track& track = tracks_[number];
        Batch& batch =
            batches_.emplace_back(Batch{turn, tracks_.size(), track.version, paces[number].step, random_, random_, {}});
        std::vector<ChangedPlan>& changes = batch.flights.changes;
        for (int tries = 0; tries < 4 * changes_side_by_side && changes.size() < changes_side_by_side; ++tries) {
            if (auto change = changed(track.plan.points, track.plan.ticks, batch.step, batch.flights.counts)) {
                changes.push_back(std::move(*change));
            }
        }
        batch.after = random_;
        paces[number].fail();
        drawn.push_back(&batch.flights);
        bases.push_back(&track.plan);
    }
    random_ = now;
    change_flights_.fly_nominal(drawn, bases);
    // A flight that was ended from outside says nothing of what it would have come to.
    const bool is_interrupted = std::any_of(drawn.begin(), drawn.end(), [](const ChangeBatch* batch) {
        return std::any_of(batch->jobs.begin(), batch->jobs.end(),
                           [](const FleetJob& job) { return job.jobs.front().rejection() == Rejection::interrupted; });
    });
    if (is_interrupted) {
        batches_.erase(batches_.begin() + 1, batches_.end());
    }
}

/// Whether a batch is what would be drawn now.
template <class Family>
bool PlanRefinerOf<Family>::is_due(const Batch& batch) const {
    const Track& track = tracks_[turn_ % tracks_.size()];
    return batch.turn == turn_ && batch.tracks == tracks_.size() && batch.version == track.version &&
           batch.step == track.pace.step && batch.before == random_;
}

template <class Family>
auto PlanRefinerOf<Family>::next_batch() -> Batch {
    if (batches_.empty() || !is_due(batches_.front())) {
        batches_.clear();
        draw_batches();
    }
    Batch batch = std::move(batches_.front());
    batches_.pop_front();
    random_ = batch.after;
    flights_.add(batch.flights.counts);
    return batch;
}

template <class Family>
void PlanRefinerOf<Family>::improve() {
    if (tracks_.empty()) {
        return;
    }
    Batch batch = next_batch();
    const std::size_t number = turn_++ % tracks_.size();
    Track& track = tracks_[number];
    if (std::optional<FlownPlan> best = change_flights_.best_of(track.plan, batch.flights)) {
        track.plan = std::move(*best);
        track.version = ++versions_;
        if (track.plan.cost < (1 - lineage_step) * track.kept_cost) {
            track.lineage.push_back(plan_of(track.plan));
            track.kept_cost = track.plan.cost;
        }
        track.pace.succeed();
        failures_in_a_row_ = 0;
    } else {
        track.pace.fail();
        ++failures_in_a_row_;
    }
    ++track.batches;
    if (number > 0) {
        if (track.plan.cost < tracks_.front().plan.cost) {
            std::swap(tracks_.front(), track);
            tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(number));
        } else if (track.batches >= batches_to_overtake ||
                   (track.batches >= batches_to_come_near &&
                    track.plan.cost > near_cost_ratio * tracks_.front().plan.cost)) {
            tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(number));
        }
    }
}

template <class Family>
auto PlanRefinerOf<Family>::moments_of(const FlownPlan& flown) const -> std::vector<FlightPoint> {
    // Counterexamples, at the end of a fleet, are no worlds of the task.
    const SearchWorlds* const worlds = flights_.task().worlds;
    const auto others_of = [count = worlds != nullptr ? worlds->worlds.size() : 0](const Fleet& fleet) {
        return Fleet(fleet.begin() + 1, fleet.begin() + 1 + static_cast<std::ptrdiff_t>(count));
    };
    std::vector<FlightPoint> moments;
    std::int64_t tick = 0;
    for (std::size_t i = 0; i < flown.points.size(); ++i) {
        moments.push_back({flown.fleets[i].front(), others_of(flown.fleets[i]), flown.points[i],
                           configuration_of(flown.points[i]), flown.costs[i], tick});
        tick += i < flown.ticks.size() ? flown.ticks[i] : 0;
    }
    FlightPoint end = moments.back();
    end.vehicle = flown.fleets.back().front();
    end.others = others_of(flown.fleets.back());
    end.cost = flown.cost;
    end.ticks += flights_.hold_leg(end.reference).segment.ticks();
    moments.push_back(end);
    return moments;
}

template class PlanRefinerOf<Plane>;
template class PlanRefinerOf<Space>;

}  // namespace downwash::planning
