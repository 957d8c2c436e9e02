#pragma once

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/hover_analysis.hpp"

// Where the tests let a vehicle hover.

namespace downwash::test {

inline constexpr double quarter_turn = 1.57079632679489661923;
inline constexpr double radius_m = 0.1905;
inline constexpr double hub_height_m = 0.06;
inline constexpr double ceiling_m = 5;  // of ceiling_problem, wide over everything

/// Hover with hanging arm a distance below the wide ceiling, where height has nothing to do with pitch and arm.
inline HoverAnalysis below_ceiling(const FlightModel& model, double gap_m) {
    return analyse_hover(model, 0, ceiling_m - gap_m - hub_height_m, quarter_turn);
}

/// A ceiling, a slab with edges below it, the ground, a pipe: surfaces above and below, whole and partial.
inline Problem cluttered_problem() {
    Problem problem = ceiling_problem();
    problem.obstacles.push_back(box("slab", {2, 3, 0.4}, {0, 0, 3}));
    Obstacle pipe;
    pipe.name = "pipe";
    pipe.shape = Cylinder{0.25, 6, {0, 1, 0}};
    pipe.center_world_m = {3, 0, 2.5};
    problem.obstacles.push_back(pipe);
    return problem;
}

}  // namespace downwash::test
