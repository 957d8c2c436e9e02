#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/objectives/MaximizeMinClearanceObjective.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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
    [[nodiscard]] oc::PathControl& path() const {
        return *flights.simple_setup()->getProblemDefinition()->getSolutionPath()->as<oc::PathControl>();
    }
    [[nodiscard]] Execution executed(const Plan& plan) const {
        return execute(flights.model(), start_state(flights.model(), flights.problem().start), plan.reference,
                       goals_of(flights.problem()), true);
    }

    FlightSetup flights;
};

/// Anywhere to the right of x = 2 m, above z = 3 m.
class UpperRight : public ob::GoalSampleableRegion {
 public:
    UpperRight(const FlightSetup& flights)
        : GoalSampleableRegion(flights.simple_setup()->getSpaceInformation()), flights_(flights) {}
    double distanceGoal(const ob::State* state) const override {
        const Configuration at = FlightSetup::place_of(state);
        return std::max({0.0, 2 - at[plane::x], 3 - at[plane::z]});
    }
    void sampleGoal(ob::State* state) const override {
        flights_.rest_at({2.2 + 0.1 * (samples_ % 5), 3.3, 0}, state);
        ++samples_;
    }
    unsigned int maxSampleCount() const override { return 100; }
    [[nodiscard]] int samples() const { return samples_; }

 private:
    const FlightSetup& flights_;
    mutable int samples_ = 0;
};

/// The way of the vehicle along x alone [m].
class AlongX : public ob::OptimizationObjective {
 public:
    using OptimizationObjective::OptimizationObjective;
    ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        return ob::Cost(std::abs(FlightSetup::place_of(to)[plane::x] - FlightSetup::place_of(from)[plane::x]));
    }
};

/// Places below z = 2.5 m alone.
class LowSampler : public ob::StateSampler {
 public:
    LowSampler(const ob::StateSpace* space, const FlightSetup& flights, int& asked)
        : StateSampler(space), flights_(flights), asked_(asked) {}
    void sampleUniform(ob::State* state) override {
        ++asked_;
        flights_.rest_at({rng_.uniformReal(-4, 4), rng_.uniformReal(1.5, 2.5), rng_.uniformReal(-3, 3)}, state);
    }
    void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
    void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
    const FlightSetup& flights_;
    int& asked_;
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
    problem.planner.variant = Variant::mp_arm_da;
    problem.planner.check_execution = false;
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

TEST_CASE("our planner flies to a goal that a user has written, and hovers in it") {
    Fixture f;
    const auto goal = std::make_shared<UpperRight>(f.flights);
    f.flights.simple_setup()->setGoal(goal);
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 2000) == ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(goal->samples() > 0);
    const Configuration end = FlightSetup::place_of(f.path().getStates().back());
    CHECK(end[plane::x] >= 2);
    CHECK(end[plane::z] >= 3);
    const std::optional<Plan> plan = f.flights.plan_of(f.path());
    REQUIRE(plan);
    CHECK(plan->last()[plane::x] > 1.9);
}

TEST_CASE("our planner keeps a user's objective small, and says so of one that does not add up") {
    Fixture f;
    const auto& information = f.flights.simple_setup()->getSpaceInformation();
    f.flights.simple_setup()->setOptimizationObjective(std::make_shared<AlongX>(information));
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 3000) == ob::PlannerStatus::EXACT_SOLUTION);
    ob::PlannerSolution found(nullptr);
    REQUIRE(f.flights.simple_setup()->getProblemDefinition()->getSolution(found));
    double way_m = 0;
    const std::vector<ob::State*>& states = f.path().getStates();
    for (std::size_t i = 1; i < states.size(); ++i) {
        way_m += std::abs(FlightSetup::place_of(states[i])[plane::x] - FlightSetup::place_of(states[i - 1])[plane::x]);
    }
    CHECK(found.cost_.value() == Approx(way_m));
    const double least_m =
        std::abs(FlightSetup::place_of(states.back())[plane::x] - f.flights.problem().start.at[plane::x]);
    CHECK(way_m < 1.02 * least_m);  // no way back and forth

    f.flights.simple_setup()->setOptimizationObjective(
        std::make_shared<ob::MaximizeMinClearanceObjective>(information));
    CHECK(f.solve(f.flights.make_flight_tree_planner(), 100) == ob::PlannerStatus::ABORT);
}

TEST_CASE("our planner ends with the first plan that a user's objective is satisfied with") {
    Fixture f;
    const auto& information = f.flights.simple_setup()->getSpaceInformation();
    const auto objective = std::make_shared<AlongX>(information);
    objective->setCostThreshold(ob::Cost(1000));
    f.flights.simple_setup()->setOptimizationObjective(objective);
    ob::IterationTerminationCondition budget(1'000'000);
    f.flights.simple_setup()->setPlanner(f.flights.make_flight_tree_planner());
    REQUIRE(f.flights.simple_setup()->solve(budget) == ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(budget.getTimesCalled() < 1'000'000);
}

TEST_CASE("our planner draws places with a user's state sampler, and under a user's objective with its informed one") {
    Fixture f;
    int asked = 0;
    const auto& space = f.flights.simple_setup()->getStateSpace();
    space->setStateSamplerAllocator([&](const ob::StateSpace* s) -> ob::StateSamplerPtr {
        return std::make_shared<LowSampler>(s, f.flights, asked);
    });
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 1000) == ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(asked > 0);
    ob::PlannerData data(f.flights.simple_setup()->getSpaceInformation());
    f.flights.simple_setup()->getPlannerData(data);
    int high = 0;
    for (unsigned int i = 0; i < data.numVertices(); ++i) {
        high += FlightSetup::place_of(data.getVertex(i).getState())[plane::z] > 2.6 ? 1 : 0;
    }
    CHECK(high < static_cast<int>(data.numVertices()) / 2);  // the goal and the ways into it alone
}

TEST_CASE("in an uncertain problem every planner flies in all worlds, and ours gets certificates") {
    Problem problem = test::uncertain_problem();
    problem.planner.max_failure_probability = 0.2;
    Fixture f(problem);
    REQUIRE(f.solve(f.flights.make_flight_tree_planner(), 3000) == ob::PlannerStatus::EXACT_SOLUTION);
    REQUIRE(f.flights.certificate());
    CHECK(f.flights.certificate()->is_given);
    CHECK(f.path().check());
    REQUIRE(f.flights.plan_of(f.path()));

    ompl::RNG::setSeed(7);
    f.flights.simple_setup()->clear();
    REQUIRE(f.solve(std::make_shared<oc::RRT>(f.flights.simple_setup()->getSpaceInformation()), 20000) ==
            ob::PlannerStatus::EXACT_SOLUTION);
    CHECK(f.path().check());
    const std::optional<Plan> plan = f.flights.plan_of(f.path());
    REQUIRE(plan);
    CHECK(f.flights.certify(*plan).worlds > 0);
}

TEST_CASE("a state can be stored and read back, with the vehicle in every world") {
    Problem problem = test::uncertain_problem();
    problem.planner.certify = false;
    problem.robot.controller.delay_s = GENERATE(0.0, 0.025);  // some worlds see more than three ticks late
    Fixture f(problem);
    const auto& space = f.flights.simple_setup()->getStateSpace();
    ob::ScopedState<> start(space), copy(space);
    start = f.flights.simple_setup()->getProblemDefinition()->getStartState(0);
    std::vector<char> bytes(space->getSerializationLength());
    space->serialize(bytes.data(), start.get());
    space->deserialize(copy.get(), bytes.data());
    CHECK(space->equalStates(start.get(), copy.get()));
    f.flights.rest_at({0, 2, 0}, copy.get());
    CHECK_FALSE(space->equalStates(start.get(), copy.get()));
}

TEST_CASE("a problem that cannot be planned leads to its errors") {
    Problem problem = test::ceiling_problem();
    problem.start.at[plane::z] = -100;
    CHECK_THROWS_AS(FlightSetup(problem), InputError);
    problem = test::ceiling_problem();
    problem.goals_before.push_back(problem.goal);
    CHECK_THROWS_WITH(FlightSetup(problem), Catch::Contains("expected one goal"));
    problem = test::ceiling_problem();
    problem.planner.variant = Variant::mp_arm;
    CHECK_THROWS_WITH(FlightSetup(problem), Catch::Contains("expected mp-arm-da or mp-arm-ada"));
}
