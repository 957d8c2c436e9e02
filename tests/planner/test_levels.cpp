#include <catch2/catch.hpp>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

// What the levels of awareness share, and in what they differ.

using namespace downwash;

TEST_CASE("MP-ARM's plans pass corners at speed like those of the other variants") {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = Variant::mp_arm;
    problem.obstacles.push_back(test::box("post", {0.3, 8, 2}, {0, 0, 1}));
    problem.planner.max_iterations = 600;
    problem.planner.check_execution = false;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    bool moves_at_a_corner = false;
    for (std::size_t i = 1; i + 1 < solution.plan->reference.size(); ++i) {
        moves_at_a_corner = moves_at_a_corner || !is_at_rest(solution.plan->reference[i].point);
    }
    CHECK(moves_at_a_corner);
    CHECK(solution.planning.edges_simulated == 0);
    CHECK(solution.planning.simulated_s == 0);
    CHECK(solution.planning.states_checked > 0);
}
