#include "downwash/search/change_flights.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <iterator>
#include <numeric>
#include <utility>

#include "downwash/controllers/space_duration.hpp"

namespace downwash::planning {
namespace {

/// Costs that are nothing but ticks differ by rounding where they are the same.
constexpr double same_cost = 1e-9;

/// @param saved see ChangeFlights::saved_before_rounding()
bool is_better(double cost, double old_cost, double saved) {
    return cost < (saved > same_cost ? old_cost + same_cost : old_cost);
}

}  // namespace

template <class Family>
ChangeFlightsOf<Family>::ChangeFlightsOf(FlightPoint start, PlannedFlights& flights)
    : start_(std::move(start)), flights_(flights) {}

template <class Family>
auto ChangeFlightsOf<Family>::timed(std::vector<ReferencePoint> points, const std::vector<std::int64_t>& old_ticks,
                                    std::size_t first, std::size_t last, FlightStatistics& counts) const
    -> std::optional<ChangedPlan> {
    ChangedPlan change{std::move(points), {}, first, last};
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

template <class Family>
auto ChangeFlightsOf<Family>::job_for(const Fleet& from, const ChangedPlan& change, std::size_t first,
                                      std::size_t last) const -> FleetJob {
    const double tick_s = flights_.task().tick_s;
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

template <class Family>
double ChangeFlightsOf<Family>::nominal_cost_after(const FlownPlan& base, const ChangedPlan& change,
                                                   const FleetJob& job) const {
    double cost = base.nominal_costs[change.first];
    const FlightState* before = &base.fleets[change.first].front();
    for (const FlightLeg& leg : job.legs()) {
        cost = flights_.cost_after(cost, *before, leg);
        before = &leg.end;
    }
    return cost;
}

template <class Family>
auto ChangeFlightsOf<Family>::flown(const FlownPlan& base, const ChangedPlan& change, const FleetJob& job) const
    -> FlownPlan {
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

template <class Family>
auto ChangeFlightsOf<Family>::flown_whole(const std::vector<ChangedPlan>& plans)
    -> std::vector<std::optional<FlownPlan>> {
    FlownPlan start;
    start.fleets.push_back(flights_.fleet_at_start(start_.vehicle));
    start.costs.push_back(0);
    start.nominal_costs.push_back(0);
    std::vector<FleetJob> jobs;
    jobs.reserve(plans.size());
    for (const ChangedPlan& plan : plans) {
        jobs.push_back(job_for(start.fleets[0], plan, 0, plan.ticks.size() - 1));
    }
    flights_.fly(jobs);
    std::vector<std::optional<FlownPlan>> flown_plans(plans.size());
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (jobs[i].is_accepted()) {
            ChangedPlan whole = plans[i];
            whole.first = 0;
            flown_plans[i] = flown(start, whole, jobs[i]);
        }
    }
    return flown_plans;
}

template <class Family>
double ChangeFlightsOf<Family>::saved_before_rounding(const FlownPlan& base, const ChangedPlan& change) const {
    const SearchTask& task = flights_.task();
    if (task.problem.planner.objective.single() != Objective::time || !flights_.limits().max_thrust_ratio) {
        return 0;
    }
    const auto needed_s = [&](const std::vector<ReferencePoint>& points, std::size_t first, std::size_t last) {
        constexpr double parts = 64;
        const double part_s = task.tick_s / parts;
        std::int64_t all = 0;
        for (std::size_t i = first; i <= last; ++i) {
            all += shortest_ticks(points[i], points[i + 1], flights_.limits(), part_s);
        }
        return static_cast<double>(all) * part_s;
    };
    const std::size_t last_before = change.last + base.ticks.size() - change.ticks.size();
    return needed_s(base.points, change.first, last_before) - needed_s(change.points, change.first, change.last);
}

template <class Family>
bool ChangeFlightsOf<Family>::is_whole(const ChangedPlan& change, const FleetJob& job) {
    return change.first + job.legs().size() == change.ticks.size() + 1;
}

/// Whether a change, as far as a job flies it, is accepted in the nominal world and costs less there than the old plan
/// did up to the same place.
template <class Family>
bool ChangeFlightsOf<Family>::costs_less(const FlownPlan& base, const ChangedPlan& change, const FleetJob& job,
                                         double saved) const {
    if (!job.is_accepted()) {
        return false;
    }
    const std::size_t old_corner = change.last + 1 + base.ticks.size() - change.ticks.size();
    const double old_cost = is_whole(change, job) ? base.nominal_cost : base.nominal_costs[old_corner];
    return is_better(nominal_cost_after(base, change, job), old_cost, saved);
}

/// A change in the nominal world: its own segments and, where they get to the old plan's next corner for less, the rest
/// of the plan, hold included.
template <class Family>
class ChangeFlightsOf<Family>::Chain final : public Family::FlightChain {
 public:
    /// @param job gets the flight
    Chain(const ChangeFlights& flights, const FlownPlan& base, const ChangedPlan& change, double saved, FleetJob& job)
        : flights_(flights), base_(base), change_(change), saved_(saved), job_(job) {}

    FlightJob* next() override {
        if (asked_++ == 0) {
            job_ = flights_.job_for({base_.fleets[change_.first].front()}, change_, change_.first, change_.last);
            return &job_.jobs.front();
        }
        const std::size_t flown = asked_ - 2;  // 0: its own segments, 1: the rest
        flights_.flights_.count_nominal(flown == 0 ? job_ : rest_, counts[flown]);
        if (flown == 0 && !is_whole(change_, job_) && flights_.costs_less(base_, change_, job_, saved_)) {
            rest_ = flights_.job_for(job_.end(), change_, change_.last + 1, change_.ticks.size() - 1);
            return &rest_.jobs.front();
        }
        if (flown == 1) {
            std::ranges::copy(rest_.legs(), std::back_inserter(job_.jobs.front().legs));
        }
        return nullptr;
    }

    std::array<FlightStatistics, 2> counts;  ///< of its own segments, and of the rest

 private:
    const ChangeFlights& flights_;
    const FlownPlan& base_;
    const ChangedPlan& change_;
    double saved_;
    FleetJob& job_;
    FleetJob rest_;
    std::size_t asked_ = 0;  ///< how often for a job
};

template <class Family>
void ChangeFlightsOf<Family>::fly_nominal(std::span<ChangeBatch* const> batches,
                                          std::span<const FlownPlan* const> bases) {
    if (flights_.can_fly_chains()) {
        fly_chains(batches, bases);
        return;
    }
    for (std::size_t i = 0; i < batches.size(); ++i) {
        fly_in_two_steps(*batches[i], *bases[i]);
    }
}

template <class Family>
void ChangeFlightsOf<Family>::fly_chains(std::span<ChangeBatch* const> batches,
                                         std::span<const FlownPlan* const> bases) {
    std::deque<Chain> flights;
    std::vector<FlightChain*> chains;
    for (std::size_t i = 0; i < batches.size(); ++i) {
        ChangeBatch& batch = *batches[i];
        batch.jobs.resize(batch.changes.size());
        for (std::size_t change = 0; change < batch.changes.size(); ++change) {
            batch.saved.push_back(saved_before_rounding(*bases[i], batch.changes[change]));
            chains.push_back(
                &flights.emplace_back(*this, *bases[i], batch.changes[change], batch.saved.back(), batch.jobs[change]));
        }
    }
    flights_.fly(chains);
    // All counts of a batch in the order in which its flights would follow one another in two steps.
    auto first = flights.begin();
    for (ChangeBatch* const batch : batches) {
        const auto last = first + static_cast<std::ptrdiff_t>(batch->changes.size());
        for (const std::size_t step : {0U, 1U}) {
            for (auto flight = first; flight != last; ++flight) {
                batch->counts += flight->counts[step];
            }
        }
        first = last;
    }
}

/// For flights that cannot be flown as chains.
template <class Family>
void ChangeFlightsOf<Family>::fly_in_two_steps(ChangeBatch& batch, const FlownPlan& base) {
    for (const ChangedPlan& change : batch.changes) {
        batch.jobs.push_back(job_for({base.fleets[change.first].front()}, change, change.first, change.last));
        batch.saved.push_back(saved_before_rounding(base, change));
    }
    flights_.fly_nominal(batch.jobs);
    std::vector<std::size_t> unfinished;
    std::vector<FleetJob> rests;
    for (std::size_t i = 0; i < batch.jobs.size(); ++i) {
        const ChangedPlan& change = batch.changes[i];
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

template <class Family>
auto ChangeFlightsOf<Family>::best_of(const FlownPlan& base, ChangeBatch& batch) -> std::optional<FlownPlan> {
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
        const ChangedPlan& change = batch.changes[i];
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

template class ChangeFlightsOf<Plane>;
template class ChangeFlightsOf<Space>;

}  // namespace downwash::planning
