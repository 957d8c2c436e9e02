#pragma once

#include <cstring>
#include <vector>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/hover_analysis.hpp"

// Where the tests let a vehicle hover and fly.

namespace downwash::test {

inline constexpr double radius_m = 0.1905;
inline constexpr double hub_height_m = 0.06;
inline constexpr double ceiling_m = 5;  // of ceiling_problem, wide over everything

/// A vehicle far from everything.
inline FlightModel in_free_air(const Robot& robot) {
    AeroSettings calm;
    calm.enabled = false;
    return {robot, {}, std::make_shared<const Scene>(std::vector<Obstacle>{}), calm};
}

/// Hover with hanging arm a distance below the wide ceiling, where height has nothing to do with pitch and arm.
inline HoverAnalysis below_ceiling(const FlightModel& model, double gap_m) {
    return analyse_hover(model, 0, ceiling_m - gap_m - hub_height_m, quarter_turn);
}

/// The wide ceiling alone.
inline Problem ceiling_alone() {
    Problem problem = ceiling_problem();
    problem.obstacles = {problem.obstacles[1]};
    return problem;
}

/// Hover anywhere in the cluttered problem, the arm in any direction.
inline HoverAnalysis random_hover(const FlightModel& model, Random& random) {
    const double x_m = random.uniform(-2, 4);
    const double z_m = random.uniform(0.2, 4.9);
    return analyse_hover(model, x_m, z_m, random.uniform(-2 * quarter_turn, 2 * quarter_turn));
}

/// The bounds and the margin of a problem.
inline FlightRules rules_of(const Problem& problem) {
    FlightRules rules;
    rules.bounds = problem.bounds;
    rules.margin_m = problem.planner.safety_margin_m;
    return rules;
}

/// The same flights one after the other, tick by tick.
inline void fly_one_by_one(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                           std::vector<FlightJob>& jobs) {
    for (FlightJob& job : jobs) {
        FlightState state = job.start;
        std::int64_t tick = job.first_tick;
        for (FlightLeg& leg : job.legs) {
            leg.flight = fly(model, map, rules, leg.segment, state, {job.world, tick});
            tick += leg.flight.ticks;
            leg.end = state;
            if (leg.flight.rejection != Rejection::none) {
                break;
            }
        }
    }
}

inline bool is_same(const FlightLeg& a, const FlightLeg& b) {
    const FlightSums& sums = a.flight;
    const FlightSums& other_sums = b.flight;
    return a.flight.rejection == b.flight.rejection && a.flight.ticks == b.flight.ticks &&
           std::memcmp(&sums, &other_sums, sizeof sums) == 0 &&
           a.flight.clearance_integral == b.flight.clearance_integral && downwash::is_same(a.end, b.end);
}

}  // namespace downwash::test
