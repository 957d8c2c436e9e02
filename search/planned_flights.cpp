#include "downwash/search/planned_flights.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

FlightRules planning_rules(const Problem& problem, std::function<bool()> is_over) {
    FlightRules rules;
    rules.margin_m = problem.planner.safety_margin_m;
    rules.bounds = problem.bounds;
    rules.is_over = std::move(is_over);
    rules.measures_clearance = problem.planner.objective.weight(Objective::clearance) > 0;
    return rules;
}

bool same_bytes(const FlightState& a, const FlightState& b) {
    static_assert(std::is_trivially_copyable_v<FlightState> && sizeof(FlightState) % sizeof(double) == 0);
    return std::memcmp(&a, &b, sizeof(FlightState)) == 0;
}

}  // namespace

std::string cause_of(Rejection rejection) {
    switch (rejection) {
        case Rejection::collision:
            return "collision";
        case Rejection::flyable_area:
            return "flyable_area";
        case Rejection::saturation:
            return "saturation";
        case Rejection::tracking:
            return "tracking";
        case Rejection::unstable:
            return "unstable";
        case Rejection::bounds:
            return "bounds";
        case Rejection::goal_missed:
            return "goal_missed";
        case Rejection::none:
        case Rejection::interrupted:
            break;
    }
    throw std::logic_error("a flight that was not refused has no cause of refusal");
}

std::map<std::string, std::uint64_t> no_rejections() {
    return {{"collision", 0}, {"flyable_area", 0}, {"saturation", 0},    {"tracking", 0}, {"unstable", 0},
            {"bounds", 0},    {"goal_missed", 0},  {"direct_flight", 0}, {"too_long", 0}};
}

FlightStatistics& FlightStatistics::operator+=(const FlightStatistics& other) {
    edges += other.edges;
    ticks += other.ticks;
    states_checked += other.states_checked;
    rejections += other.rejections;
    for (const auto& [cause, count] : other.rejected) {
        rejected[cause] += count;
    }
    if (other.obstruction && (!obstruction || other.obstruction->goal_distance_m < obstruction->goal_distance_m)) {
        obstruction = other.obstruction;
    }
    return *this;
}

PlannedFlights::PlannedFlights(const Problem& problem, const FlightModel& model, const SearchSpace& space,
                               const AeroMap* map, std::function<bool()> is_over, int threads,
                               std::optional<FlightState> start)
    : problem_(problem),
      model_(model),
      space_(space),
      map_(map),
      limits_(reference_limits(problem.motion)),
      start_(start ? *start : start_state(model, problem.start)),
      crew_(model, map, planning_rules(problem, std::move(is_over)), &problem.goal, threads) {
    statistics_.rejected = no_rejections();
}

PlannedFlights::PlannedFlights(const PlannedFlights& others, int threads)
    : problem_(others.problem_),
      model_(others.model_),
      space_(others.space_),
      map_(others.map_),
      limits_(others.limits_),
      start_(others.start_),
      crew_(model_, map_, others.rules(), &problem_.goal, threads) {
    statistics_.rejected = no_rejections();
}

void PlannedFlights::count_rejection(const std::string& cause) {
    ++statistics_.rejected[cause];
    ++statistics_.rejections;
}

void PlannedFlights::count_rejection(Rejection rejection) {
    if (rejection != Rejection::interrupted) {
        count_rejection(cause_of(rejection));
    }
}

bool PlannedFlights::leads_to_goal(const ReferenceSegment& segment) const {
    return space_.is_near_goal(configuration_of(segment.to()));
}

void PlannedFlights::refuse(const ReferenceSegment& segment, Rejection rejection, const Configuration& at) {
    count_rejection(rejection);
    if (rejection == Rejection::interrupted || !leads_to_goal(segment)) {
        return;
    }
    const double distance_m = space_.goal_distance_m(at);
    std::optional<Obstruction>& nearest = statistics_.obstruction;
    if (!nearest || distance_m < nearest->goal_distance_m) {
        nearest = {cause_of(rejection), at, distance_m};
    }
}

bool PlannedFlights::is_worth_flying(const ReferenceSegment& segment) {
    constexpr double spacing_m = 0.1;
    const ReferencePoint& a = segment.from();
    const ReferencePoint& b = segment.to();
    const double arm_m = problem_.robot.arm.length_m;
    const auto weighted = [arm_m](const double* v) { return std::abs(v[0]) + std::abs(v[1]) + arm_m * std::abs(v[2]); };
    const double step[3] = {b.position[0] - a.position[0], b.position[1] - a.position[1],
                            b.position[2] - a.position[2]};
    // Ends that move may lead beyond the line between them.
    const double motion_m = weighted(step) + (weighted(a.velocity) + weighted(b.velocity)) * segment.duration_s();
    const auto samples = static_cast<std::int64_t>(std::ceil(motion_m / spacing_m)) + 1;
    const auto at = [&](std::int64_t i) { return configuration_of(segment.at_tick(segment.ticks() * i / samples)); };
    Rejection rejection = Rejection::none;
    for (std::int64_t i = samples; i >= 1 && rejection == Rejection::none;
         --i) {  // the new end first: likelier to collide
        ++statistics_.states_checked;
        rejection = space_.rejection_at(at(i));
    }
    if (rejection == Rejection::none) {
        return true;
    }
    if (!leads_to_goal(segment)) {
        count_rejection(rejection);
        return false;
    }
    // Of a way to the goal the place matters where a flight would have been stopped.
    std::int64_t first = 1;
    while (space_.rejection_at(at(first)) == Rejection::none) {
        ++first;
    }
    refuse(segment, space_.rejection_at(at(first)), at(first));
    return false;
}

void PlannedFlights::fly(std::span<FlightJob> jobs) {
    crew_.fly(jobs);
    for (const FlightJob& job : jobs) {
        for (const FlightLeg& leg : job.legs) {
            statistics_.edges += leg.flight.ticks > 0 ? 1 : 0;
            statistics_.ticks += static_cast<std::uint64_t>(leg.flight.ticks);
            statistics_.states_checked += static_cast<std::uint64_t>(leg.flight.ticks);
        }
        if (const FlightLeg* leg = job.refused_leg()) {
            refuse(leg->segment, leg->flight.rejection, configuration_of(leg->end.plant.q));
        }
    }
}

void PlannedFlights::verify(std::span<const ReferenceKnot> knots, std::span<const FlightState> states) const {
    FlightRules to_the_end = rules();
    to_the_end.is_over = {};
    FlightState state = start_;
    for (std::size_t i = 1; i < states.size(); ++i) {
        const ReferenceKnot& from = knots[i - 1];
        const ReferenceSegment segment =
            i < knots.size()
                ? ReferenceSegment(from.point, knots[i].point, knots[i].tick - from.tick, model_.tick().tick_s)
                : hold_leg(from.point).segment;
        const SegmentFlight flight = downwash::fly(model_, map_, to_the_end, segment, state);
        if (flight.rejection != Rejection::none || !same_bytes(state, states[i])) {
            throw std::logic_error("flying a plan again did not reproduce the planner's flight bit for bit");
        }
    }
}

FlightLeg PlannedFlights::hold_leg(const ReferencePoint& at) const {
    const double tick_s = model_.tick().tick_s;
    return {{at, at, hold_ticks(problem_.goal, model_, at), tick_s}};
}

std::int64_t PlannedFlights::judged_ticks() const {
    return std::llround(goal_settling_s / model_.tick().tick_s);
}

double PlannedFlights::cost_after(double cost_before, const FlightState& from, const FlightLeg& leg) const {
    const double time_s = static_cast<double>(leg.flight.ticks) * model_.tick().tick_s;
    return cost_before + problem_.planner.objective({leg.end.plant.energy_j - from.plant.energy_j, time_s,
                                                     leg.flight.length_m, leg.flight.clearance_integral});
}

ReferenceSegment PlannedFlights::fastest_segment(const ReferencePoint& from, const ReferencePoint& to) const {
    const double tick_s = model_.tick().tick_s;
    return {from, to, shortest_ticks(from, to, limits_, tick_s), tick_s};
}

}  // namespace downwash::planning
