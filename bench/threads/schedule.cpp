#include "schedule.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <list>
#include <memory>
#include <utility>

namespace downwash::bench {
namespace {

using Then = std::function<void()>;

constexpr int tree = 1, refinement = 2, outside_rounds = -1;

/// Simulated processors that are shared evenly among the threads that want to run.
class Processors {
 public:
    enum class Use : std::uint8_t { serial, flight, wait };

    explicit Processors(int count) : count_(count) {}

    /// A thread works for so long, or waits without a processor, and then goes on.
    void run(double left_s, Use use, Then then) {
        runs_.push_back({left_s, use, std::move(then)});
        if (use != Use::wait) {
            ++(use == Use::serial ? serial_ : flying_);
        }
    }

    /// Until nobody runs or waits any more. @param on_idle told of the time of idle processors, and of the share of
    /// serial work in what goes on meanwhile
    void run_to_end(const std::function<void(double idle_s, double serial_share)>& on_idle) {
        while (!runs_.empty()) {
            const int wanting = serial_ + flying_;
            const double rate = wanting > count_ ? static_cast<double>(count_) / wanting : 1;
            double passes_s = HUGE_VAL;
            for (const Run& run : runs_) {
                passes_s = std::min(passes_s, run.use == Use::wait ? run.left_s : run.left_s / rate);
            }
            now_s_ += passes_s;
            used_s_ += passes_s * rate * wanting;
            if (wanting < count_) {
                on_idle(passes_s * (count_ - wanting), wanting > 0 ? static_cast<double>(serial_) / wanting : 0);
            }
            std::list<Run> ended;
            for (auto run = runs_.begin(); run != runs_.end();) {
                const auto next = std::next(run);
                run->left_s -= run->use == Use::wait ? passes_s : passes_s * rate;
                if (run->left_s <= 1e-12) {
                    ended.splice(ended.end(), runs_, run);
                }
                run = next;
            }
            for (const Run& run : ended) {
                if (run.use != Use::wait) {
                    --(run.use == Use::serial ? serial_ : flying_);
                }
            }
            for (const Run& run : ended) {
                run.then();
            }
        }
    }

    [[nodiscard]] double now_s() const noexcept { return now_s_; }
    [[nodiscard]] double used_s() const noexcept { return used_s_; }

 private:
    struct Run {
        double left_s;
        Use use;
        Then then;
    };
    int count_;
    std::list<Run> runs_;
    int serial_ = 0, flying_ = 0;
    double now_s_ = 0, used_s_ = 0;
};

/// A batch under way: see FlightPool::fly().
struct BatchFlight {
    const WorkItem& batch;
    std::size_t lanes_used;
    std::size_t next_job = 0;
    std::size_t working;
    Then then;
};

/// The lanes of a thread that flies a batch: see FlightPool::Impl::work().
struct FlyingThread {
    std::shared_ptr<BatchFlight> flight;
    std::vector<std::int64_t> lanes;  ///< ticks left
};

class Simulation {
 public:
    explicit Simulation(const SchedulePolicy& policy) : policy_(policy), processors_(std::max(1, policy.threads)) {}

    Schedule run(const std::vector<WorkStage>& stages) {
        stages_ = &stages;
        for (const WorkStage& stage : stages) {
            add_work(stage.before);
            for (const auto& steps : stage.round.tasks) {
                std::ranges::for_each(steps, [this](const WorkChain& step) { add_work(step); });
            }
        }
        begin_stage(0);
        processors_.run_to_end([this](double idle_s, double serial_share) {
            Schedule::Idle& idle = !in_round_ ? result_.outside : one_has_ended_() ? result_.round_end : result_.inside;
            idle.serial_s += idle_s * serial_share;
            idle.flights_s += idle_s * (1 - serial_share);
        });
        result_.wall_s = processors_.now_s();
        result_.narrow_s = processors_.used_s() - result_.work_s;
        return result_;
    }

 private:
    /// A task of the round under way.
    struct Task {
        const std::vector<WorkChain>* steps = nullptr;
        std::size_t next = 0;
        std::size_t running = 0;
        double spent_s = 0;
        [[nodiscard]] bool has_step() const noexcept { return next < steps->size(); }
        [[nodiscard]] bool has_ended() const noexcept { return !has_step() && running == 0; }
    };

    void add_work(const WorkChain& chain) {
        for (const WorkItem& item : chain) {
            result_.work_s += item.work_s;
        }
    }

    [[nodiscard]] bool one_has_ended_() const { return tasks_[tree].has_ended() || tasks_[refinement].has_ended(); }

    void begin_stage(std::size_t number) {
        if (number == stages_->size()) {
            return;
        }
        const WorkStage& stage = (*stages_)[number];
        run_chain(stage.before, 0, outside_rounds, [this, number] { begin_round(number); });
    }

    void begin_round(std::size_t number) {
        const WorkRound& round = (*stages_)[number].round;
        for (std::size_t i = 0; i < 3; ++i) {
            tasks_[i] = {&round.tasks[i]};
        }
        if (std::ranges::all_of(tasks_, [](const Task& task) { return task.has_ended(); })) {
            begin_stage(number + 1);
            return;
        }
        in_round_ = true;
        // As FlightTreePlanner::go_on_side_by_side() splits them.
        const int refiners = std::max(1, policy_.threads / 2);
        allowed_[refinement] = refiners;
        allowed_[tree] = std::max(1, policy_.threads - refiners);
        allowed_[0] = policy_.threads;
        const int most = policy_.steps_in_flight > 1 ? 1 + 2 * policy_.steps_in_flight : policy_.max_workers;
        workers_ = std::min(policy_.threads, most);
        const int workers = workers_;
        for (int i = 0; i < workers; ++i) {
            work_on_tasks(number);
        }
    }

    /// What a worker of run_side_by_side() does next.
    void work_on_tasks(std::size_t stage) {
        Task* mine = nullptr;
        for (Task& task : tasks_) {
            const std::size_t most = &task == tasks_.data() ? 1 : static_cast<std::size_t>(policy_.steps_in_flight);
            if (task.has_step() && task.running < most && (mine == nullptr || task.spent_s < mine->spent_s)) {
                mine = &task;
            }
        }
        if (mine == nullptr) {
            if (--workers_ == 0) {
                in_round_ = false;
                begin_stage(stage + 1);
            }
            return;
        }
        const WorkChain& step = (*mine->steps)[mine->next++];
        ++mine->running;
        const auto number = static_cast<int>(mine - tasks_.data());
        const double began_s = processors_.now_s();
        run_step(step, number, [this, mine, number, began_s, stage] {
            mine->spent_s += processors_.now_s() - began_s;
            --mine->running;
            if (mine->has_ended() && number != 0) {
                allowed_[static_cast<std::size_t>(number == tree ? refinement : tree)] = policy_.threads;
            }
            work_on_tasks(stage);
        });
    }

    /// The direct flight of an execution with a certificate, which is all before its first batch, beside the rest.
    void run_step(const WorkChain& step, int task, Then then) {
        const bool has_flight =
            task == 0 && policy_.flies_beside && policy_.threads > 1 && !step.empty() &&
            step[0].kind == WorkItem::Kind::serial &&
            std::ranges::any_of(step, [](const WorkItem& item) { return item.kind == WorkItem::Kind::batch; });
        if (!has_flight) {
            run_chain(step, 0, task, std::move(then));
            return;
        }
        const auto ended = std::make_shared<int>(0);
        const Then join = [ended, then = std::move(then)] {
            if (++*ended == 2) {
                then();
            }
        };
        processors_.run(step[0].work_s, Processors::Use::serial, join);
        run_chain(step, 1, task, join);
    }

    /// Threads that may work on a piece of a task.
    [[nodiscard]] int threads_for(int task) const {
        if (task == outside_rounds) {
            return policy_.threads;
        }
        const Task& of = tasks_[static_cast<std::size_t>(task)];
        return std::max(
            1, allowed_[static_cast<std::size_t>(task)] / static_cast<int>(std::max<std::size_t>(1, of.running)));
    }

    void run_chain(const WorkChain& chain, std::size_t next, int task, Then then) {
        if (next == chain.size()) {
            then();
            return;
        }
        const WorkItem& item = chain[next];
        Then go_on = [this, &chain, next, task, then = std::move(then)] { run_chain(chain, next + 1, task, then); };
        switch (item.kind) {
            case WorkItem::Kind::serial: {
                const bool is_divisible = task == tree || task == refinement;
                const double divided_s =
                    is_divisible && threads_for(task) > 1 ? policy_.divided_share * item.work_s : 0;
                processors_.run(item.work_s - divided_s, Processors::Use::serial,
                                [this, divided_s, task, go_on = std::move(go_on)] {
                                    const auto threads = static_cast<std::size_t>(threads_for(task));
                                    share_out(divided_s / static_cast<double>(threads), divided_s > 0 ? threads : 0,
                                              threads, go_on);
                                });
                break;
            }
            case WorkItem::Kind::parallel:
                share_out(item.work_s / static_cast<double>(std::max<std::size_t>(1, item.items)), item.items,
                          static_cast<std::size_t>(policy_.threads), go_on);
                break;
            case WorkItem::Kind::batch:
                fly(item, threads_for(task), std::move(go_on));
                break;
        }
    }

    /// So many items of the same length, each taken by a thread.
    void share_out(double item_s, std::size_t items, std::size_t threads, const Then& then) {
        if (items == 0) {
            then();
            return;
        }
        struct Left {
            std::size_t items, working;
        };
        threads = std::min(threads, items);
        const auto left = std::make_shared<Left>(Left{items, threads});
        const auto take = std::make_shared<std::function<void()>>();
        // The function holds itself only while a thread is in it.
        *take = [this, left, item_s, then, self = std::weak_ptr(take)] {
            if (left->items > 0) {
                --left->items;
                processors_.run(item_s, Processors::Use::serial, [again = self.lock()] { (*again)(); });
            } else if (--left->working == 0) {
                then();
            }
        };
        for (std::size_t i = 0; i < threads; ++i) {
            if (i == 0) {
                (*take)();
            } else {
                processors_.run(policy_.wake_s, Processors::Use::wait, [take] { (*take)(); });
            }
        }
    }

    void fly(const WorkItem& batch, int threads, Then then) {
        const std::size_t jobs = batch.ticks.size();
        const std::size_t helpers = jobs <= 2 ? 0 : static_cast<std::size_t>(threads - 1);
        const std::size_t lanes = std::clamp<std::size_t>((jobs + helpers) / (helpers + 1), 1, WorkPiece::max_lanes);
        const auto flight = std::make_shared<BatchFlight>(BatchFlight{batch, lanes, 0, helpers + 1, std::move(then)});
        for (std::size_t i = 0; i < helpers; ++i) {
            processors_.run(policy_.wake_s, Processors::Use::wait, [this, flight] { take_jobs({flight, {}}); });
        }
        take_jobs({flight, {}});
    }

    void take_jobs(FlyingThread thread) {
        BatchFlight& flight = *thread.flight;
        const std::vector<std::int64_t>& jobs = flight.batch.ticks;
        while (thread.lanes.size() < flight.lanes_used && flight.next_job < jobs.size()) {
            if (const std::int64_t ticks = jobs[flight.next_job++]; ticks > 0) {
                thread.lanes.push_back(ticks);
            }
        }
        if (thread.lanes.empty()) {
            if (--flight.working == 0) {
                flight.then();
            }
            return;
        }
        const std::int64_t passes = *std::min_element(thread.lanes.begin(), thread.lanes.end());
        const double time_s = static_cast<double>(passes) * flight.batch.tick.at(static_cast<int>(thread.lanes.size()));
        for (std::int64_t& left : thread.lanes) {
            left -= passes;
        }
        std::erase(thread.lanes, 0);
        processors_.run(time_s, Processors::Use::flight, [this, thread = std::move(thread)] { take_jobs(thread); });
    }

    const SchedulePolicy& policy_;
    Processors processors_;
    const std::vector<WorkStage>* stages_ = nullptr;
    std::array<Task, 3> tasks_;
    std::array<int, 3> allowed_{};
    int workers_ = 0;
    bool in_round_ = false;
    Schedule result_;
};

/// The first items of some steps as one, then the second ones and so on: serial work one after the other, batches as
/// one batch.
WorkChain merged(std::span<const WorkChain> steps) {
    WorkChain all;
    std::size_t longest = 0;
    std::vector<WorkChain> batches_of(steps.size());
    double serial_s = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        for (const WorkItem& item : steps[i]) {
            if (item.kind == WorkItem::Kind::batch) {
                batches_of[i].push_back(item);
            } else {
                serial_s += item.work_s;
            }
        }
        longest = std::max(longest, batches_of[i].size());
    }
    for (std::size_t k = 0; k <= longest; ++k) {
        WorkItem serial;
        serial.work_s = serial_s / static_cast<double>(longest + 1);
        all.push_back(serial);
        WorkItem batch;
        batch.kind = WorkItem::Kind::batch;
        double weight = 0;
        for (const WorkChain& batches : batches_of) {
            if (k >= batches.size()) {
                continue;
            }
            const WorkItem& item = batches[k];
            batch.ticks.insert(batch.ticks.end(), item.ticks.begin(), item.ticks.end());
            weight += item.work_s;
            batch.tick.few_s += item.work_s * item.tick.few_s;
            batch.tick.many_s += item.work_s * item.tick.many_s;
            batch.tick.lane_s += item.work_s * item.tick.lane_s;
        }
        if (weight > 0) {
            batch.tick = {batch.tick.few_s / weight, batch.tick.many_s / weight, batch.tick.lane_s / weight};
            batch.work_s = one_thread_time_s(batch.ticks, batch.tick);
            all.push_back(std::move(batch));
        }
    }
    return all;
}

/// A plan's execution whose certificate flies so many of its chunks at once. A chunk is two batches of 64 flights: the
/// hover at the start, and the plan to its only goal.
WorkChain flown_ahead(const WorkChain& chain, std::size_t chunks) {
    constexpr std::size_t chunk_jobs = 64;
    const auto is_full = [](const WorkItem& item) {
        return item.kind == WorkItem::Kind::batch && item.ticks.size() == chunk_jobs;
    };
    WorkChain all;
    std::vector<WorkChain> pending;  // chunks, the last of which may lack its second batch
    const auto finish = [&] {
        for (std::size_t i = 0; i < pending.size(); i += chunks) {
            const WorkChain together = merged(std::span(pending).subspan(i, std::min(chunks, pending.size() - i)));
            all.insert(all.end(), together.begin(), together.end());
        }
        pending.clear();
    };
    for (const WorkItem& item : chain) {
        if (is_full(item)) {
            if (pending.empty() || pending.back().size() == 2) {
                pending.emplace_back();
            }
            pending.back().push_back(item);
        } else if (item.kind == WorkItem::Kind::serial && !pending.empty()) {
            all.push_back(item);  // worlds are drawn between chunks
        } else {
            finish();
            all.push_back(item);
        }
    }
    finish();
    return all;
}

std::vector<WorkStage> with_merged(const SearchWork& work, const SchedulePolicy& policy) {
    std::vector<WorkStage> stages;
    std::size_t rounds = 0;
    for (const WorkStage& stage : work.stages) {
        const bool has_round = std::ranges::any_of(stage.round.tasks, [](const auto& steps) { return !steps.empty(); });
        const bool joins = has_round && rounds > 0 && rounds % static_cast<std::size_t>(policy.rounds_merged) != 0;
        rounds += has_round ? 1 : 0;
        if (!joins) {
            stages.push_back(stage);
            continue;
        }
        WorkStage& last = stages.back();
        last.before.insert(last.before.end(), stage.before.begin(), stage.before.end());
        for (std::size_t task = 0; task < 3; ++task) {
            auto& steps = last.round.tasks[task];
            steps.insert(steps.end(), stage.round.tasks[task].begin(), stage.round.tasks[task].end());
        }
    }
    const auto chunks = static_cast<std::size_t>(policy.flies_ahead ? policy.threads / 16 : 1);
    if (chunks > 1) {
        for (WorkStage& stage : stages) {
            for (WorkChain& execution : stage.round.tasks[0]) {
                execution = flown_ahead(execution, chunks);
            }
        }
    }
    const auto width = static_cast<std::size_t>(policy.steps_merged);
    if (width > 1) {
        for (WorkStage& stage : stages) {
            for (const int task : {tree, refinement}) {
                std::vector<WorkChain>& steps = stage.round.tasks[static_cast<std::size_t>(task)];
                std::vector<WorkChain> wide;
                for (std::size_t i = 0; i < steps.size(); i += width) {
                    wide.push_back(merged(std::span(steps).subspan(i, std::min(width, steps.size() - i))));
                }
                steps = std::move(wide);
            }
        }
    }
    return stages;
}

}  // namespace

Schedule simulate(const SearchWork& work, const SchedulePolicy& policy) {
    return Simulation(policy).run(with_merged(work, policy));
}

}  // namespace downwash::bench
