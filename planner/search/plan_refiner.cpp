#include "downwash/search/plan_refiner.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace downwash::planning {
namespace {

constexpr int changes_side_by_side = 8;

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
    : start_(std::move(start)), flights_(flights), changes_(flights, random) {}

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
        if (batch == 0) {
            for (const double share : repair_shares) {
                if (auto change = moved_into_goal(plan, share)) {
                    changes.push_back(std::move(*change));
                }
            }
        }
        for (int tries = 0; tries < 4 * changes_side_by_side && changes.size() < changes_side_by_side; ++tries) {
            if (auto change = changed(plan.points, plan.ticks, repair_step)) {
                changes.push_back(std::move(*change));
            }
        }
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
    Track track{std::move(plan), std::move(lineage), cost, ++taken_};
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
                                                        const std::vector<std::int64_t>& ticks, double step) {
    auto drawn = changes_.draw(points, ticks, step);
    return drawn ? timed(std::move(drawn->points), ticks, drawn->first_segment, drawn->last_segment) : std::nullopt;
}

std::optional<PlanRefiner::Change> PlanRefiner::moved_into_goal(const Change& plan, double share) {
    const Configuration end = configuration_of(plan.points.back());
    const Configuration moved = flights_.goal().moved_into(end, share);
    if (moved == end) {
        return std::nullopt;
    }
    std::vector<ReferencePoint> points = plan.points;
    points.back() = at_rest(moved);
    return timed(std::move(points), plan.ticks, plan.ticks.size() - 1, plan.ticks.size() - 1);
}

/// Gives segments `first` to `last` as few ticks as they need, if they may be worth flying. The others keep their
/// ticks; their numbers may have shifted by a corner more or less.
std::optional<PlanRefiner::Change> PlanRefiner::timed(std::vector<ReferencePoint> points,
                                                      const std::vector<std::int64_t>& old_ticks, std::size_t first,
                                                      std::size_t last) {
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
            if (!keeps_limits(segment, flights_.limits()) || !flights_.is_worth_flying(segment)) {
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

/// Flies changes in the nominal world: their own segments first and, where one gets to the old plan's next corner for
/// less, the rest of the plan, hold included. The promising ones are flown in the other worlds, the cheapest first,
/// until one is accepted and cheaper there, too.
std::optional<FlownPlan> PlanRefiner::best_of(const FlownPlan& base, const std::vector<Change>& changes) {
    std::vector<FleetJob> jobs;
    jobs.reserve(changes.size());
    for (const Change& change : changes) {
        jobs.push_back(job_for({base.fleets[change.first].front()}, change, change.first, change.last));
    }
    flights_.fly_nominal(jobs);
    const auto is_whole = [&](std::size_t i) {
        return changes[i].first + jobs[i].legs().size() == changes[i].ticks.size() + 1;
    };
    std::vector<double> saved;
    saved.reserve(changes.size());
    for (const Change& change : changes) {
        saved.push_back(saved_before_rounding(base, change));
    }
    // Costs that are nothing but ticks differ by rounding where they are the same.
    constexpr double same_cost = 1e-9;
    const auto is_better = [&](std::size_t i, double cost, double old_cost) {
        return cost < (saved[i] > same_cost ? old_cost + same_cost : old_cost);
    };
    const auto costs_less = [&](std::size_t i) {
        const std::size_t old_corner = changes[i].last + 1 + base.ticks.size() - changes[i].ticks.size();
        const double old_cost = is_whole(i) ? base.nominal_cost : base.nominal_costs[old_corner];
        return jobs[i].is_accepted() && is_better(i, nominal_cost_after(base, changes[i], jobs[i]), old_cost);
    };
    std::vector<std::size_t> unfinished;
    std::vector<FleetJob> rests;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (costs_less(i) && !is_whole(i)) {
            unfinished.push_back(i);
            rests.push_back(job_for(jobs[i].end(), changes[i], changes[i].last + 1, changes[i].ticks.size() - 1));
        }
    }
    flights_.fly_nominal(rests);
    for (std::size_t i = 0; i < rests.size(); ++i) {
        std::ranges::copy(rests[i].legs(), std::back_inserter(jobs[unfinished[i]].jobs.front().legs));
    }
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (is_whole(i) && costs_less(i)) {
            promising.push_back(i);
        }
    }
    std::stable_sort(promising.begin(), promising.end(), [&](std::size_t a, std::size_t b) {
        return nominal_cost_after(base, changes[a], jobs[a]) - saved[a] <
               nominal_cost_after(base, changes[b], jobs[b]) - saved[b];
    });
    for (const std::size_t i : promising) {
        const Change& change = changes[i];
        std::vector<FleetJob> whole{job_for(base.fleets[change.first], change, change.first, change.ticks.size() - 1)};
        whole.front().jobs.front() = std::move(jobs[i].jobs.front());
        flights_.fly_in_other_worlds(whole);
        if (whole.front().is_accepted()) {
            FlownPlan plan = flown(base, change, whole.front());
            if (is_better(i, plan.cost, base.cost)) {
                return plan;
            }
        }
    }
    return std::nullopt;
}

void PlanRefiner::improve() {
    if (tracks_.empty()) {
        return;
    }
    const std::size_t number = turn_++ % tracks_.size();
    Track& track = tracks_[number];
    std::vector<Change> changes;
    for (int tries = 0; tries < 4 * changes_side_by_side && changes.size() < changes_side_by_side; ++tries) {
        if (auto change = changed(track.plan.points, track.plan.ticks, track.step)) {
            changes.push_back(std::move(*change));
        }
    }
    const std::optional<FlownPlan> best = best_of(track.plan, changes);
    if (best) {
        track.plan = *best;
        if (track.plan.cost < (1 - lineage_step) * track.kept_cost) {
            track.lineage.push_back(plan_of(track.plan));
            track.kept_cost = track.plan.cost;
        }
        track.step = std::min(1.0, 1.5 * track.step);
        track.failures = 0;
    } else {
        track.step = std::max(min_step, 0.9 * track.step);
        if (++track.failures >= max_failures) {
            track.step = 1;
            track.failures = 0;
        }
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
