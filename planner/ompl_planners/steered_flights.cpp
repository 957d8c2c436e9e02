#include "downwash/ompl_planners/steered_flights.hpp"

#include <algorithm>
#include <iterator>
#include <span>

namespace downwash::planning {
namespace {

/// A flight may close from so far away [m], the arm's turn counted as way.
constexpr double closing_range_m = 0.5;

/// The vehicle at a moment, in every world.
template <class Family>
FleetOf<Family> fleet_of(const FlightPointOf<Family>& point) {
    FleetOf<Family> fleet{point.vehicle};
    fleet.insert(fleet.end(), point.others.begin(), point.others.end());
    return fleet;
}

template <class ReferencePoint>
bool stands_still(const ReferencePoint& point) {
    return std::ranges::all_of(point.velocity, [](double rate) { return rate == 0; });
}

}  // namespace

template <class Family>
SteeredFlightsOf<Family>::SteeredFlightsOf(PlannedFlights& flights)
    : flights_(flights), task_(flights.task()), steps_(task_.space.axes(), flights.limits(), task_.tick_s) {}

template <class Family>
auto SteeredFlightsOf<Family>::start() const -> FlightPoint {
    FlightPoint point = start_point(task_);
    if (task_.worlds != nullptr) {
        point.others = task_.worlds->start;
    }
    point.rest = steps_.rest_of(point.reference);
    return point;
}

template <class Family>
auto SteeredFlightsOf<Family>::steered(const FlightPoint& from, const double* velocity) const -> FlightPoint {
    FlightPoint next = from;
    next.reference = steps_.after(from.reference, velocity);
    next.rest = steps_.rest_of(next.reference);
    next.ticks = from.ticks + steps_.ticks();
    next.is_valid = false;
    return next;
}

template <class Family>
auto SteeredFlightsOf<Family>::stepped(const FlightPoint& from, const double* velocity) const -> FlightPoint {
    FlightPoint next = steered(from, velocity);
    if (static_cast<double>(next.ticks) + steps_.braking_ticks(next.reference) > static_cast<double>(max_plan_ticks)) {
        flights_.count_rejection("too_long");
        return next;
    }
    // Where it leaves a limit it could only stop, or turn, outside.
    if (const Rejection left = task_.space.limit_left_at(next.rest); left != Rejection::none) {
        flights_.count_rejection(left);
        return next;
    }
    const ReferenceSegment segment(from.reference, next.reference, steps_.ticks(), task_.tick_s);
    FleetJob job = flights_.job(fleet_of(from), from.ticks, {{segment}});
    flights_.fly(std::span(&job, 1));
    arrive(next, from, job);
    return next;
}

/// Where a flight along one segment has led.
template <class Family>
void SteeredFlightsOf<Family>::arrive(FlightPoint& next, const FlightPoint& from, const FleetJob& job) const {
    next.vehicle = job.jobs.front().end();
    next.is_valid = job.is_accepted();
    if (next.is_valid) {
        const Fleet fleet = job.end();
        next.others.assign(fleet.begin() + 1, fleet.end());
        next.cost = flights_.cost_after(from.cost, fleet_of(from), job, 0);
    }
}

template <class Family>
auto SteeredFlightsOf<Family>::stepped_again(const FlightPoint& from, const double* velocity) const -> FlightPoint {
    const FlightPoint next = steered(from, velocity);
    FlightPoint flown = followed(from, next.reference, steps_.ticks());
    flown.rest = next.rest;
    return flown;
}

template <class Family>
auto SteeredFlightsOf<Family>::followed(const FlightPoint& from, const ReferencePoint& to, std::int64_t ticks) const
    -> FlightPoint {
    FlightPoint next = from;
    const ReferenceSegment segment(from.reference, to, ticks, task_.tick_s);
    FleetJob job = flights_.job(fleet_of(from), from.ticks, {{segment}});
    flights_.fly_again(job);
    next.reference = to;
    next.rest = configuration_of(to);
    next.ticks = from.ticks + ticks;
    arrive(next, from, job);
    return next;
}

template <class Family>
bool SteeredFlightsOf<Family>::is_worth_closing(const FlightPoint& point) const {
    return task_.space.goal_distance_m(point.rest) <= closing_range_m;
}

template <class Family>
auto SteeredFlightsOf<Family>::closing(const FlightPoint& from) const -> std::optional<Closing> {
    // The middle of the goal leaves the whole tolerance to the flight; where an obstacle stands there, its rim does
    // too.
    Configuration goal = task_.space.moved_into_goal(from.rest, 0);
    if (!task_.space.is_valid(goal)) {
        goal = task_.space.moved_into_goal(from.rest, usable_tolerance_share);
    }
    if (const Rejection rejection = task_.space.rejection_at(goal); rejection != Rejection::none) {
        flights_.count_rejection(rejection);
        return std::nullopt;
    }
    goal = task_.space.seen_from(configuration_of(from.reference), goal);
    const ReferenceSegment segment = flights_.fastest_segment(from.reference, at_rest(goal));
    if (segment.ticks() > max_plan_ticks - from.ticks) {
        flights_.count_rejection("too_long");
        return std::nullopt;
    }
    const Fleet fleet = fleet_of(from);
    FleetJob job =
        flights_.job(fleet, from.ticks, {{segment}, flights_.hold_leg(segment.to())}, flights_.judged_ticks());
    flights_.fly(std::span(&job, 1));
    if (!job.is_accepted()) {
        return std::nullopt;
    }
    const double arrived = flights_.cost_after(from.cost, fleet, job, 0);
    const double cost = flights_.cost_after(arrived, job.fleet_after(0), job, 1);
    return Closing{{from.ticks + segment.ticks(), segment.to()}, job.legs()[0].end, job.legs()[1].end, cost};
}

template <class Family>
auto SteeredFlightsOf<Family>::plan(const std::vector<FlightPoint>& points, const std::optional<Closing>& end) const
    -> Plan {
    Plan plan = task_.blank_plan;
    for (const FlightPoint& point : points) {
        plan.reference.push_back({point.ticks, point.reference});
    }
    if (end) {
        plan.reference.push_back(end->goal);
    } else {
        constexpr double still[std::size(ReferencePoint{}.velocity)]{};
        while (!stands_still(plan.reference.back().point)) {
            const auto& last = plan.reference.back();
            plan.reference.push_back({last.tick + steps_.ticks(), steps_.after(last.point, still)});
        }
    }
    return plan;
}

template <class Family>
void SteeredFlightsOf<Family>::verify(const std::vector<FlightPoint>& points, const Closing& end) const {
    std::vector<FlightPoint> moments = points;
    moments.push_back({end.arrival, {}, end.goal.point, {}, 0, end.goal.tick});
    const std::int64_t hold_ticks = flights_.hold_leg(end.goal.point).segment.ticks();
    moments.push_back({end.end, {}, end.goal.point, {}, end.cost, end.goal.tick + hold_ticks});
    flights_.verify(moments);
}

template class SteeredFlightsOf<Plane>;
template class SteeredFlightsOf<Space>;

}  // namespace downwash::planning
