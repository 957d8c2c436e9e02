#pragma once

// What the tests of solve() share: problems of each variant, and searches with a wrong map.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/solve.hpp"

namespace downwash::test {

inline constexpr Variant variants[] = {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada};

inline Problem with(Variant variant, Problem problem = ceiling_problem()) {
    problem.planner.variant = variant;
    return problem;
}

/// Geometric planners need more iterations than those that fly.
inline Problem with(Variant variant, std::uint64_t geometric_iterations, std::uint64_t flown_iterations) {
    Problem problem = with(variant);
    problem.planner.max_iterations = variant == Variant::mp_arm ? geometric_iterations : flown_iterations;
    return problem;
}

/// Where the vehicle arrives and cannot hold.
inline Problem right_under_the_ceiling() {
    Problem problem = with_place(0, 5 - 0.06 - 0.16);
    configuration(problem.goal).tolerance_m = 0.02;
    problem.planner.safety_margin_m = 0.01;
    return problem;
}

inline std::shared_ptr<const AeroMap> map_as_if(const Problem& problem, std::vector<Obstacle> obstacles) {
    Problem other = problem;
    other.obstacles = std::move(obstacles);
    return make_flight_model(other)->make_map(problem.bounds);
}

/// Searches with a map as if other obstacles were there: plans that fly through it may do otherwise when flown
/// directly.
inline planning::SearchResult solve_deceived(const Problem& problem, std::vector<Obstacle> obstacles) {
    const auto model = make_flight_model(problem);
    return planning::search_goal(problem, problem,
                                 {problem.planner.variant, model, map_as_if(problem, std::move(obstacles))},
                                 planning::Course::from_start(problem, *model), {}, {});
}

}  // namespace downwash::test
