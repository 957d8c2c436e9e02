#include <catch2/catch.hpp>
#include <cmath>

#include "../judge/shipped.hpp"
#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;

namespace {

Solution solved_with(CollisionCheckerKind kind, Problem problem, std::uint32_t seed) {
    problem.planner.collision_checker = kind;
    problem.planner.seed = seed;
    return solve(problem);
}

/// Searches with either checker come to the same plan by the same way, to the last bit, and its flight keeps as far
/// from obstacles.
/// @return how many searches had a plan
int require_agreement(const Problem& problem, std::uint32_t seeds) {
    int plans = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Solution own = solved_with(CollisionCheckerKind::own, problem, seed);
        const Solution fcl = solved_with(CollisionCheckerKind::fcl, problem, seed);
        CAPTURE(problem.name, name_of(problem.planner.variant), seed);
        REQUIRE(own.status == fcl.status);
        CHECK(own.planning.edges_simulated == fcl.planning.edges_simulated);
        CHECK(own.planning.rejected == fcl.planning.rejected);
        REQUIRE(own.plan.has_value() == fcl.plan.has_value());
        if (own.plan) {
            ++plans;
            CHECK(test::same_bytes(*own.plan, *fcl.plan));
            CHECK(test::same_bytes(*own.execution, *fcl.execution));
            CHECK(own.execution->outcome == fcl.execution->outcome);
            if (std::isfinite(own.execution->min_clearance_m)) {
                CHECK(std::abs(own.execution->min_clearance_m - fcl.execution->min_clearance_m) < 1e-3);
            }
        }
    }
    return plans;
}

}  // namespace

TEST_CASE("plans of both collision checkers agree, whatever the variant and the algorithm") {
    int plans = 0;
    for (Problem problem : {test::ceiling_problem(), test::cluttered_problem()}) {
        problem.planner.max_iterations = 60;
        for (const Variant variant : all_variants) {
            problem.planner.variant = variant;
            plans += require_agreement(problem, 2);
        }
        problem.planner.variant = Variant::mp_arm_da;
        problem.planner.algorithm = "rrt";
        plans += require_agreement(problem, 1);
    }
    CHECK(plans >= 7);  // of 14
}

TEST_CASE("plans of both collision checkers agree on the shipped problems") {
    int plans = 0;
    for (const char* name : test::shipped_names) {
        Problem problem = test::shipped(name);
        problem.uncertainty.reset();
        problem.planner.time_limit_s.reset();
        problem.planner.variant = Variant::mp_arm_da;  // needs no aero map
        problem.planner.max_iterations = 30;
        plans += require_agreement(problem, 2);
    }
    CHECK(plans >= 8);  // of 16
}

TEST_CASE("a search obeys planner.collision_checker, and so does the check of its problem") {
    Problem problem = test::cluttered_problem();
    const PlanarPose pose{2.1, 1.7, 0.1, 0.3};
    CHECK(make_flight_model(problem)->collisions().kind() == CollisionCheckerKind::own);
    const double own_m = make_flight_model(problem)->collisions().clearance_m(pose);
    problem.planner.collision_checker = CollisionCheckerKind::fcl;
    const auto model = plannable(problem).model;
    CHECK(model->collisions().kind() == CollisionCheckerKind::fcl);
    // FCL's distance from a pipe differs in its last digits: it is not ours under another name.
    CHECK(model->collisions().clearance_m(pose) == Approx(own_m).margin(1e-3));
    CHECK(model->collisions().clearance_m(pose) != own_m);
}
