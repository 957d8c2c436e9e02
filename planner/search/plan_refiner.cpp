#include "downwash/search/plan_refiner.hpp"

#include <algorithm>
#include <array>
#include <numeric>
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

PlanRefiner::PlanRefiner(FlightPoint start, PlannedFlights& flights, Random& random)
    : start_(std::move(start)), flights_(flights), random_(random), changes_(flights, random) {}

void PlanRefiner::Pace::succeed() noexcept {
    step = std::min(1.0, 1.5 * step);
    failures = 0;
}

void PlanRefiner::Pace::fail() noexcept {
    step = std::max(min_step, 0.9 * step);
    if (++failures >= max_failures) {
        step = 1;
        failures = 0;
    }
}

const FlownPlan* PlanRefiner::best() const noexcept {
    return tracks_.empty() ? nullptr : &tracks_.front().plan;
}

void PlanRefiner::drop(int number) {
    std::erase_if(tracks_, [number](const Track& track) { return track.number == number; });
}

FleetJob PlanRefiner::job_for(const Fleet& from, const Change& change, std::size_t first, std::size_t last) const {
    const double tick_s = flights_.task().model.tick().tick_s;
    std::vector<FlightLeg> legs;
    std::int64_t judged_ticks = 0;
    for (std::size_t i = first; i <= last; ++i) {
        legs.push_back({{change.points[i], change.points[i + 1], change.ticks[i], tick_s}});
    }
    if (last + 1 == change.ticks.size()) {
        legs.push_back(flights_.hold_leg(change.points.back()));
        judged_ticks = flights_.judged_ticks();
    }
    const auto before = change.ticks.begin() + static_cast<std::ptrdiff_t>(first);
    return flights_.job(from, std::accumulate(change.ticks.begin(), before, std::int64_t{0}), std::move(legs),
                        judged_ticks);
}

double PlanRefiner::nominal_cost_after(const FlownPlan& base, const Change& change, const FleetJob& job) const {
    double cost = base.nominal_costs[change.first];
    const FlightState* before = &base.fleets[change.first].front();
    for (const FlightLeg& leg : job.legs()) {
        cost = flights_.cost_after(cost, *before, leg);
        before = &leg.end;
    }
    return cost;
}

FlownPlan PlanRefiner::flown(const FlownPlan& base, const Change& change, const FleetJob& job) const {
    FlownPlan plan;
    plan.points = change.points;
    plan.ticks = change.ticks;
    const auto kept = static_cast<std::ptrdiff_t>(change.first) + 1;
    plan.fleets.assign(base.fleets.begin(), base.fleets.begin() + kept);
    plan.costs.assign(base.costs.begin(), base.costs.begin() + kept);
    plan.nominal_costs.assign(base.nominal_costs.begin(), base.nominal_costs.begin() + kept);
    const std::size_t hold = job.legs().size() - 1;
    for (std::size_t leg = 0; leg < hold; ++leg) {
        plan.costs.push_back(flights_.cost_after(plan.costs.back(), plan.fleets.back(), job, leg));
        plan.nominal_costs.push_back(
            flights_.cost_after(plan.nominal_costs.back(), plan.fleets.back().front(), job.legs()[leg]));
        plan.fleets.push_back(job.fleet_after(leg));
    }
    plan.cost = flights_.cost_after(plan.costs.back(), plan.fleets.back(), job, hold);
    plan.nominal_cost = flights_.cost_after(plan.nominal_costs.back(), plan.fleets.back().front(), job.legs()[hold]);
    plan.fleets.push_back(job.end());
    return plan;
}

std::vector<std::optional<FlownPlan>> PlanRefiner::flown_whole(const std::vector<Change>& plans) {
    FlownPlan start;
    start.fleets.push_back(flights_.fleet_at_start(start_.vehicle));
    start.costs.push_back(0);
    start.nominal_costs.push_back(0);
    std::vector<FleetJob> jobs;
    jobs.reserve(plans.size());
    for (const Change& plan : plans) {
        jobs.push_back(job_for(start.fleets[0], plan, 0, plan.ticks.size() - 1));
    }
    flights_.fly(jobs);
    std::vector<std::optional<FlownPlan>> flown_plans(plans.size());
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (jobs[i].is_accepted()) {
            Change whole = plans[i];
            whole.first = 0;
            flown_plans[i] = flown(start, whole, jobs[i]);
        }
    }
    return flown_plans;
}

/// The cheapest of some changed plans that fly in all worlds, of the first batch that has any.
std::optional<FlownPlan> PlanRefiner::repaired(const Change& plan) {
    for (int batch = 0; batch < repair_batches; ++batch) {
        std::vector<Change> changes;
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
        for (std::optional<FlownPlan>& flown : flown_whole(changes)) {
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

PlanRefiner::Change PlanRefiner::as_change(const Plan& plan) {
    Change change;
    for (std::size_t i = 0; i < plan.reference.size(); ++i) {
        change.points.push_back(plan.reference[i].point);
        if (i > 0) {
            change.ticks.push_back(plan.reference[i].tick - plan.reference[i - 1].tick);
        }
    }
    return change;
}

void PlanRefiner::work_on(Lineage lineage, std::size_t steps_back) {
    if (lineage.back().reference.size() < 2) {
        return;  // the start meets the goal: there is nothing on the way
    }
    const Change last = as_change(lineage.back());
    std::optional<FlownPlan> flown;
    if (steps_back == 0) {
        flown = std::move(flown_whole({last}).front());
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
std::optional<FlownPlan> PlanRefiner::last_that_flies(Lineage& lineage) {
    for (; !lineage.empty(); lineage.pop_back()) {
        if (std::optional<FlownPlan> flown = std::move(flown_whole({as_change(lineage.back())}).front())) {
            return flown;
        }
    }
    return std::nullopt;
}

void PlanRefiner::add(FlownPlan plan, Lineage lineage) {
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

Plan PlanRefiner::plan_of(const FlownPlan& flown) const {
    return plan_through(moments_of(flown), flights_.task().model.tick().tick_s);
}

std::vector<Lineage> PlanRefiner::release() {
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

std::optional<PlanRefiner::Change> PlanRefiner::changed(const std::vector<ReferencePoint>& points,
                                                        const std::vector<std::int64_t>& ticks, double step,
                                                        FlightStatistics& counts) {
    auto drawn = changes_.draw(points, ticks, step);
    return drawn ? timed(std::move(drawn->points), ticks, drawn->first_segment, drawn->last_segment, counts)
                 : std::nullopt;
}

std::optional<PlanRefiner::Change> PlanRefiner::moved_into_goal(const Change& plan, double share,
                                                                FlightStatistics& counts) const {
    const Configuration end = configuration_of(plan.points.back());
    const Configuration moved = flights_.goal().moved_into(end, share);
    if (moved == end) {
        return std::nullopt;
    }
    std::vector<ReferencePoint> points = plan.points;
    points.back() = at_rest(moved);
    return timed(std::move(points), plan.ticks, plan.ticks.size() - 1, plan.ticks.size() - 1, counts);
}

/// Gives segments `first` to `last` as few ticks as they need, if they may be worth flying. The others keep their
/// ticks; their numbers may have shifted by a corner more or less.
std::optional<PlanRefiner::Change> PlanRefiner::timed(std::vector<ReferencePoint> points,
                                                      const std::vector<std::int64_t>& old_ticks, std::size_t first,
                                                      std::size_t last, FlightStatistics& counts) const {
    Change change{std::move(points), {}, first, last};
    const std::size_t segments = change.points.size() - 1;
    const std::size_t old_segments = old_ticks.size();
    const auto keeps_limits_at = [&](std::size_t corner) {
        return keeps_limits(change.points[corner], flights_.limits());
    };
    std::int64_t total = 0;
    for (std::size_t i = 0; i < segments; ++i) {
        if (i >= first && i <= last) {
            if (!keeps_limits_at(i) || !keeps_limits_at(i + 1)) {
                return std::nullopt;
            }
            const ReferenceSegment segment = flights_.fastest_segment(change.points[i], change.points[i + 1]);
            if (!keeps_limits(segment, flights_.limits()) || !flights_.is_worth_flying(segment, counts)) {
                return std::nullopt;
            }
            change.ticks.push_back(segment.ticks());
        } else {
            change.ticks.push_back(old_ticks[i < first ? i : i + old_segments - segments]);
        }
        total += change.ticks.back();
    }
    return total <= max_plan_ticks ? std::optional(std::move(change)) : std::nullopt;
}

double PlanRefiner::saved_before_rounding(const FlownPlan& base, const Change& change) const {
    const SearchTask& task = flights_.task();
    if (task.problem.planner.objective.single() != Objective::time || !flights_.limits().max_thrust_ratio) {
        return 0;
    }
    const auto needed_s = [&](const std::vector<ReferencePoint>& points, std::size_t first, std::size_t last) {
        constexpr double parts = 64;
        const double part_s = task.model.tick().tick_s / parts;
        std::int64_t all = 0;
        for (std::size_t i = first; i <= last; ++i) {
            all += shortest_ticks(points[i], points[i + 1], flights_.limits(), part_s);
        }
        return static_cast<double>(all) * part_s;
    };
    const std::size_t last_before = change.last + base.ticks.size() - change.ticks.size();
    return needed_s(base.points, change.first, last_before) - needed_s(change.points, change.first, change.last);
}

namespace {

/// Costs that are nothing but ticks differ by rounding where they are the same.
constexpr double same_cost = 1e-9;

/// @param saved see PlanRefiner::saved_before_rounding()
bool is_better(double cost, double old_cost, double saved) {
    return cost < (saved > same_cost ? old_cost + same_cost : old_cost);
}

}  // namespace

/// Whether a change, as far as a job flies it, is accepted in the nominal world and costs less there than the old plan
/// did up to the same place.
bool PlanRefiner::costs_less(const FlownPlan& base, const Change& change, const FleetJob& job, double saved) const {
    if (!job.is_accepted()) {
        return false;
    }
    const std::size_t old_corner = change.last + 1 + base.ticks.size() - change.ticks.size();
    const double old_cost = is_whole(change, job) ? base.nominal_cost : base.nominal_costs[old_corner];
    return is_better(nominal_cost_after(base, change, job), old_cost, saved);
}

bool PlanRefiner::is_whole(const Change& change, const FleetJob& job) {
    return change.first + job.legs().size() == change.ticks.size() + 1;
}

/// A change in the nominal world: its own segments and, where they get to the old plan's next corner for less, the rest
/// of the plan, hold included.
class PlanRefiner::ChangeFlight final : public FlightChain {
 public:
    /// @param job gets the flight
    ChangeFlight(const PlanRefiner& refiner, const FlownPlan& base, const Change& change, double saved, FleetJob& job)
        : refiner_(refiner), base_(base), change_(change), saved_(saved), job_(job) {}

    FlightJob* next() override {
        if (asked_++ == 0) {
            job_ = refiner_.job_for({base_.fleets[change_.first].front()}, change_, change_.first, change_.last);
            return &job_.jobs.front();
        }
        const std::size_t flown = asked_ - 2;  // 0: its own segments, 1: the rest
        refiner_.flights_.count_nominal(flown == 0 ? job_ : rest_, counts[flown]);
        if (flown == 0 && !is_whole(change_, job_) && refiner_.costs_less(base_, change_, job_, saved_)) {
            rest_ = refiner_.job_for(job_.end(), change_, change_.last + 1, change_.ticks.size() - 1);
            return &rest_.jobs.front();
        }
        if (flown == 1) {
            std::ranges::copy(rest_.legs(), std::back_inserter(job_.jobs.front().legs));
        }
        return nullptr;
    }

    std::array<FlightStatistics, 2> counts;  ///< of its own segments, and of the rest

 private:
    const PlanRefiner& refiner_;
    const FlownPlan& base_;
    const Change& change_;
    double saved_;
    FleetJob& job_;
    FleetJob rest_;
    std::size_t asked_ = 0;  ///< how often for a job
};

/// Flies changes in the nominal world.
/// @param tracks that the batches were drawn from
void PlanRefiner::fly_nominal(std::span<Batch> batches, std::span<const Track* const> tracks) {
    std::deque<ChangeFlight> flights;
    std::vector<FlightChain*> chains;
    for (std::size_t i = 0; i < batches.size(); ++i) {
        Batch& batch = batches[i];
        batch.jobs.resize(batch.changes.size());
        for (std::size_t change = 0; change < batch.changes.size(); ++change) {
            batch.saved.push_back(saved_before_rounding(tracks[i]->plan, batch.changes[change]));
            chains.push_back(&flights.emplace_back(*this, tracks[i]->plan, batch.changes[change], batch.saved.back(),
                                                   batch.jobs[change]));
        }
    }
    flights_.fly(chains);
    // All counts of a batch in the order in which its flights would follow one another in two steps.
    auto first = flights.begin();
    for (Batch& batch : batches) {
        const auto last = first + static_cast<std::ptrdiff_t>(batch.changes.size());
        for (const std::size_t step : {0U, 1U}) {
            for (auto flight = first; flight != last; ++flight) {
                batch.counts += flight->counts[step];
            }
        }
        first = last;
    }
}

/// The same of flights that cannot be flown as chains.
void PlanRefiner::fly_in_two_steps(Batch& batch, const FlownPlan& base) {
    for (const Change& change : batch.changes) {
        batch.jobs.push_back(job_for({base.fleets[change.first].front()}, change, change.first, change.last));
        batch.saved.push_back(saved_before_rounding(base, change));
    }
    flights_.fly_nominal(batch.jobs);
    std::vector<std::size_t> unfinished;
    std::vector<FleetJob> rests;
    for (std::size_t i = 0; i < batch.jobs.size(); ++i) {
        const Change& change = batch.changes[i];
        if (!is_whole(change, batch.jobs[i]) && costs_less(base, change, batch.jobs[i], batch.saved[i])) {
            unfinished.push_back(i);
            rests.push_back(job_for(batch.jobs[i].end(), change, change.last + 1, change.ticks.size() - 1));
        }
    }
    flights_.fly_nominal(rests);
    for (std::size_t i = 0; i < rests.size(); ++i) {
        std::ranges::copy(rests[i].legs(), std::back_inserter(batch.jobs[unfinished[i]].jobs.front().legs));
    }
}

/// Flies the promising ones of a batch in the other worlds, the cheapest first, until one is accepted and cheaper
/// there, too.
std::optional<FlownPlan> PlanRefiner::best_of(const FlownPlan& base, Batch& batch) {
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < batch.jobs.size(); ++i) {
        if (is_whole(batch.changes[i], batch.jobs[i]) &&
            costs_less(base, batch.changes[i], batch.jobs[i], batch.saved[i])) {
            promising.push_back(i);
        }
    }
    std::stable_sort(promising.begin(), promising.end(), [&](std::size_t a, std::size_t b) {
        return nominal_cost_after(base, batch.changes[a], batch.jobs[a]) - batch.saved[a] <
               nominal_cost_after(base, batch.changes[b], batch.jobs[b]) - batch.saved[b];
    });
    for (const std::size_t i : promising) {
        const Change& change = batch.changes[i];
        std::vector<FleetJob> whole{job_for(base.fleets[change.first], change, change.first, change.ticks.size() - 1)};
        whole.front().jobs.front() = std::move(batch.jobs[i].jobs.front());
        flights_.fly_in_other_worlds(whole);
        if (whole.front().is_accepted()) {
            FlownPlan plan = flown(base, change, whole.front());
            if (is_better(plan.cost, base.cost, batch.saved[i])) {
                return plan;
            }
        }
    }
    return std::nullopt;
}

/// Draws the next batch of changes, and where several fly at once those that follow if it fails. All are flown.
void PlanRefiner::draw_batches() {
    const bool can_fly_chains = flights_.can_fly_chains();
    const std::size_t wanted = can_fly_chains ? std::min(failures_in_a_row_ + 1, max_batches_ahead) : 1;
    const Random now = random_;
    std::vector<Pace> paces;
    for (const Track& track : tracks_) {
        paces.push_back(track.pace);
    }
    std::vector<Batch> drawn;
    std::vector<const Track*> drawn_from;
    for (std::size_t ahead = 0; ahead < wanted; ++ahead) {
        const std::size_t turn = turn_ + ahead;
        const std::size_t number = turn % tracks_.size();
        const Track& track = tracks_[number];
        Batch batch{turn, tracks_.size(), track.version, paces[number].step, random_, random_, {}, {}, {}, {}};
        for (int tries = 0; tries < 4 * changes_side_by_side && batch.changes.size() < changes_side_by_side; ++tries) {
            if (auto change = changed(track.plan.points, track.plan.ticks, batch.step, batch.counts)) {
                batch.changes.push_back(std::move(*change));
            }
        }
        batch.after = random_;
        paces[number].fail();
        drawn.push_back(std::move(batch));
        drawn_from.push_back(&track);
    }
    random_ = now;
    if (can_fly_chains) {
        fly_nominal(drawn, drawn_from);
    } else {
        fly_in_two_steps(drawn.front(), drawn_from.front()->plan);
    }
    for (Batch& batch : drawn) {
        batches_.push_back(std::move(batch));
    }
    // A flight that was ended from outside says nothing of what it would have come to.
    const bool is_interrupted = std::any_of(batches_.begin(), batches_.end(), [](const Batch& batch) {
        return std::any_of(batch.jobs.begin(), batch.jobs.end(),
                           [](const FleetJob& job) { return job.jobs.front().rejection() == Rejection::interrupted; });
    });
    if (is_interrupted) {
        batches_.erase(batches_.begin() + 1, batches_.end());
    }
}

/// Whether a batch is what would be drawn now.
bool PlanRefiner::is_due(const Batch& batch) const {
    const Track& track = tracks_[turn_ % tracks_.size()];
    return batch.turn == turn_ && batch.tracks == tracks_.size() && batch.version == track.version &&
           batch.step == track.pace.step && batch.before == random_;
}

PlanRefiner::Batch PlanRefiner::next_batch() {
    if (batches_.empty() || !is_due(batches_.front())) {
        batches_.clear();
        draw_batches();
    }
    Batch batch = std::move(batches_.front());
    batches_.pop_front();
    random_ = batch.after;
    flights_.add(batch.counts);
    return batch;
}

void PlanRefiner::improve() {
    if (tracks_.empty()) {
        return;
    }
    Batch batch = next_batch();
    const std::size_t number = turn_++ % tracks_.size();
    Track& track = tracks_[number];
    if (std::optional<FlownPlan> best = best_of(track.plan, batch)) {
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

std::vector<FlightPoint> PlanRefiner::moments_of(const FlownPlan& flown) const {
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

}  // namespace downwash::planning
