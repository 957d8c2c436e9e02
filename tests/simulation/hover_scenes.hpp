#pragma once

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

}  // namespace downwash::test
