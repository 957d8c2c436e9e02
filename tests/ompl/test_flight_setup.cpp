#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <catch2/catch.hpp>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/ompl/flight_setup.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;

namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

/// The setup of a problem with its map; OMPL's console stays silent.
struct Fixture {
    explicit Fixture(const Problem& problem = test::ceiling_problem())
        : flights(problem, make_flight_model(problem)->make_map(problem.bounds)) {
        ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    }
    /// Solves with an iteration budget, which repeats on any machine.
    ob::PlannerStatus solve(const ob::PlannerPtr& planner, unsigned int evaluations) {
        ob::IterationTerminationCondition budget(evaluations);
        flights.simple_setup()->setPlanner(planner);
        return flights.simple_setup()->solve(budget);
    }
    [[nodiscard]] const oc::PathControl& path() const {
        return *flights.simple_setup()->getProblemDefinition()->getSolutionPath()->as<oc::PathControl>();
    }
    [[nodiscard]] Execution executed(const Plan& plan) const {
        return execute(flights.model(), start_state(flights.model(), flights.problem().start), plan.reference,
                       goals_of(flights.problem()), true);
    }

    FlightSetup flights;
};

}  // namespace

TEST_CASE("our planner runs where OMPL's planners over controls do, and its path follows OMPL's rules") {
    Fixture f;
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 3000) == ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(f.path().check());  // every control, propagated again, leads to the next state
    const std::optional<Plan> plan = f.flights.plan_of(f.path());
    REQUIRE(plan);
    CHECK(plan->first() == f.flights.problem().start.at);
    CHECK(f.executed(*plan).outcome == Outcome::ok);
}

TEST_CASE("a plan of OMPL's RRT on our flights holds at the goal when executed") {
    ompl::RNG::setSeed(7);
    Fixture f;
    REQUIRE(f.solve(std::make_shared<oc::RRT>(f.flights.simple_setup()->getSpaceInformation()), 20000) ==
            ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(f.path().check());
    const std::optional<Plan> plan = f.flights.plan_of(f.path());
    REQUIRE(plan);
    CHECK(f.executed(*plan).outcome == Outcome::ok);
}

TEST_CASE("a way that does not reach the goal is no plan") {
    Problem problem = test::ceiling_problem();
    problem.obstacles.push_back(test::box("wall", {0.3, 8, 7}, {0, 0, 2.5}));  // from ground to ceiling
    Fixture f(problem);
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 100) == ob::PlannerStatus::APPROXIMATE_SOLUTION);
    CHECK_FALSE(f.flights.plan_of(f.path()));
}

TEST_CASE("our planner has the cost there that solve() reports with the same iterations") {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = Variant::mp_arm_da;  // no plan is discarded when executed
    problem.planner.max_iterations = 120;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    const FlightSetup in_free_air(problem);
    const oc::SimpleSetupPtr& setup = in_free_air.simple_setup();
    setup->setPlanner(in_free_air.make_flight_tree_planner());
    REQUIRE(setup->solve(ob::plannerNonTerminatingCondition()) == ob::PlannerStatus::EXACT_SOLUTION);
    ob::PlannerSolution found(nullptr);
    REQUIRE(setup->getProblemDefinition()->getSolution(found));
    CHECK(found.cost_.value() == solution.cost);
    const ob::PathPtr path = setup->getProblemDefinition()->getSolutionPath();
    const std::optional<Plan> plan = in_free_air.plan_of(*path);
    REQUIRE(plan);
    REQUIRE(plan->reference.size() == solution.plan->reference.size());
    CHECK(test::same_bytes(*plan, *solution.plan));
}

TEST_CASE("a problem that cannot be planned leads to its errors") {
    Problem problem = test::ceiling_problem();
    problem.start.at[plane::z] = -100;
    CHECK_THROWS_AS(FlightSetup(problem), InputError);
    problem = test::ceiling_problem();
    problem.goals_before.push_back(problem.goal);
    CHECK_THROWS_WITH(FlightSetup(problem), Catch::Contains("expected one goal"));
}
