#include <catch2/catch.hpp>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;

namespace {

CostFunction sum(double energy, double time, double length, double clearance) {
    CostFunction cost = CostFunction::of_nothing();
    cost.weight(Objective::energy) = energy;
    cost.weight(Objective::time) = time;
    cost.weight(Objective::length) = length;
    cost.weight(Objective::clearance) = clearance;
    return cost;
}

Solution solved(const CostFunction& objective, Variant variant = Variant::mp_arm_da) {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = variant;
    problem.planner.objective = objective;
    problem.planner.max_iterations = variant == Variant::mp_arm ? 800 : 60;
    Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    return solution;
}

}  // namespace

TEST_CASE("a cost is the sum of weight times figure, with one weight of 1 that objective") {
    const CostFigures figures{{3}, 1000, 20, 7};
    CHECK(CostFunction()(figures) == 1000);
    CHECK(CostFunction(Objective::time)(figures) == 20);
    CHECK(CostFunction(Objective::length)(figures) == 3);
    CHECK(CostFunction(Objective::clearance)(figures) == 7);
    CHECK(sum(1, 50, 0, 0)(figures) == 2000);
    CHECK(sum(0, 0.5, 2, 10)(figures) == 86);
    CHECK(sum(0, 1, 0, 0) == CostFunction(Objective::time));
    CHECK(sum(0, 1, 0, 0).single() == Objective::time);
    CHECK_FALSE(sum(0, 2, 0, 0).single());
    CHECK_FALSE(sum(1, 1, 0, 0).single());
    CHECK(text_of(Objective::clearance) == "clearance");
    CHECK(text_of(sum(1, 50, 0, 0.25)) == "energy + 50 time + 0.25 clearance");
}

TEST_CASE("the cost of a flown sum is the sum of the flight's own figures") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        CAPTURE(name_of(variant));
        const Solution solution = solved(sum(1, 50, 20, 3), variant);
        const Execution& e = *solution.execution;
        CHECK(solution.execution_cost ==
              Approx(e.energy_j + 50 * e.duration_s + 20 * e.length_m + 3 * e.clearance_integral));
        for (std::size_t i = 1; i < solution.planning.improvements.size(); ++i) {
            CHECK(solution.planning.improvements[i].cost <= solution.planning.improvements[i - 1].cost);
        }
        if (variant == Variant::mp_arm_ada) {
            CHECK(solution.execution_cost == Approx(solution.cost).epsilon(0.01));
        }
    }
}

TEST_CASE("weights in another unit give the same plan") {
    // A power of two changes no digit of any number that the search compares.
    const Solution plain = solved(sum(1, 64, 0, 0));
    const Solution scaled = solved(sum(0.25, 16, 0, 0));
    CHECK(scaled.cost == plain.cost / 4);
    CHECK(test::same_bytes(*scaled.plan, *plain.plan));
}
