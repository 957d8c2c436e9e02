#include "downwash/rivals/steered_flights.hpp"

#include <span>

namespace downwash::planning {
namespace {

/// A flight may close from so far away [m], the arm's turn counted as way.
constexpr double closing_range_m = 0.5;

bool stands_still(const ReferencePoint& point) {
    return point.velocity[0] == 0 && point.velocity[1] == 0 && point.velocity[2] == 0;
}

}  // namespace

SteeredFlights::SteeredFlights(const Problem& problem, const SearchSpace& space, PlannedFlights& flights)
    : problem_(problem), space_(space), flights_(flights), steps_(flights.limits(), flights.model().tick().tick_s) {}

FlightPoint SteeredFlights::start() const {
    FlightPoint point;
    point.vehicle = flights_.start();
    point.reference = reference_at(problem_.start);
    point.rest = steps_.rest_of(point.reference);
    return point;
}

FlightPoint SteeredFlights::resting_at(const Configuration& c) const {
    const double q[4] = {c.x_m, c.z_m, 0, c.arm_rad};
    const double u[4] = {};
    FlightPoint point;
    point.vehicle = flights_.model().state_at(q, u);
    point.reference = at_rest(c);
    point.rest = c;
    return point;
}

FlightPoint SteeredFlights::steered(const FlightPoint& from, const double velocity[3]) const {
    FlightPoint next = from;
    next.reference = steps_.after(from.reference, velocity);
    next.rest = steps_.rest_of(next.reference);
    next.ticks = from.ticks + steps_.ticks();
    next.is_valid = false;
    return next;
}

FlightPoint SteeredFlights::stepped(const FlightPoint& from, const double velocity[3]) const {
    FlightPoint next = steered(from, velocity);
    if (static_cast<double>(next.ticks) + steps_.braking_ticks(next.reference) > static_cast<double>(max_plan_ticks)) {
        flights_.count_rejection("too_long");
        return next;
    }
    if (!space_.is_inside(next.rest)) {  // it could only stop, or turn, outside
        flights_.count_rejection(Rejection::bounds);
        return next;
    }
    const ReferenceSegment segment(from.reference, next.reference, steps_.ticks(), flights_.model().tick().tick_s);
    FlightJob job{from.vehicle, {{segment}}};
    flights_.fly(std::span(&job, 1));
    next.vehicle = job.end();
    next.is_valid = job.rejection() == Rejection::none;
    if (next.is_valid) {
        next.cost = flights_.cost_after(from.cost, from.vehicle, job.legs.front());
    }
    return next;
}

FlightPoint SteeredFlights::stepped_again(const FlightPoint& from, const double velocity[3]) const {
    FlightPoint next = steered(from, velocity);
    FlightRules rules = flights_.rules();
    rules.is_over = {};
    FlightLeg leg{ReferenceSegment(from.reference, next.reference, steps_.ticks(), flights_.model().tick().tick_s)};
    leg.flight = fly(flights_.model(), flights_.map(), rules, leg.segment, next.vehicle);
    leg.end = next.vehicle;
    next.is_valid = leg.flight.rejection == Rejection::none;
    next.cost = flights_.cost_after(from.cost, from.vehicle, leg);
    return next;
}

bool SteeredFlights::is_worth_closing(const FlightPoint& point) const {
    return space_.goal_distance_m(point.rest) <= closing_range_m;
}

std::optional<Closing> SteeredFlights::closing(const FlightPoint& from) const {
    // The middle of the goal leaves the whole tolerance to the flight; where an obstacle stands there, its rim does
    // too.
    Configuration goal = space_.moved_into_goal(from.rest, 0);
    if (!space_.is_valid(goal)) {
        goal = space_.moved_into_goal(from.rest, usable_tolerance_share);
    }
    if (const Rejection rejection = space_.rejection_at(goal); rejection != Rejection::none) {
        flights_.count_rejection(rejection);
        return std::nullopt;
    }
    const double* place = from.reference.position;
    goal = space_.seen_from({place[0], place[1], place[2]}, goal);
    const ReferenceSegment segment = flights_.fastest_segment(from.reference, at_rest(goal));
    if (segment.ticks() > max_plan_ticks - from.ticks) {
        flights_.count_rejection("too_long");
        return std::nullopt;
    }
    FlightJob job{from.vehicle, {{segment}, flights_.hold_leg(segment.to())}, flights_.judged_ticks()};
    flights_.fly(std::span(&job, 1));
    if (job.rejection() != Rejection::none) {
        return std::nullopt;
    }
    const double arrived = flights_.cost_after(from.cost, from.vehicle, job.legs[0]);
    const double cost = flights_.cost_after(arrived, job.legs[0].end, job.legs[1]);
    return Closing{{from.ticks + segment.ticks(), segment.to()}, job.legs[0].end, job.end(), cost};
}

Plan SteeredFlights::plan(const std::vector<FlightPoint>& points, const std::optional<Closing>& end) const {
    Plan plan;
    plan.tick_s = flights_.model().tick().tick_s;
    for (const FlightPoint& point : points) {
        plan.reference.push_back({point.ticks, point.reference});
    }
    if (end) {
        plan.reference.push_back(end->goal);
    } else {
        constexpr double still[3] = {0, 0, 0};
        while (!stands_still(plan.reference.back().point)) {
            const ReferenceKnot& last = plan.reference.back();
            plan.reference.push_back({last.tick + steps_.ticks(), steps_.after(last.point, still)});
        }
    }
    return plan;
}

void SteeredFlights::verify(const Plan& plan, const std::vector<FlightPoint>& points, const Closing& end) const {
    std::vector<FlightState> states;
    states.reserve(points.size() + 2);
    for (const FlightPoint& point : points) {
        states.push_back(point.vehicle);
    }
    states.push_back(end.arrival);
    states.push_back(end.end);
    flights_.verify(plan.reference, states);
}

}  // namespace downwash::planning
