#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/world_parameters.hpp"

// Touches among several goals, in the plane; test_space_goals.cpp has those in space.

using namespace downwash;

namespace {

/// Hover, touch, hover and touch.
Problem deck_and_pier() {
    Problem problem = read_problem(DOWNWASH_PROBLEMS "/contact/deck_and_pier.yaml");
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s.reset();
    return problem;
}

/// The same without goals, in the nominal world.
Problem empty_problem() {
    Problem problem = deck_and_pier();
    problem.uncertainty.reset();
    problem.goals_before.clear();
    problem.goal = {};
    return problem;
}

Goal touch_of_deck(double x_m) {
    Goal goal;
    auto& contact = goal.kind.emplace<ContactGoal>();
    contact.obstacle = "deck";
    contact.x_m = x_m;
    goal.hold_s = 2;
    return goal;
}

Goal touch_of_pier(double z_m) {
    Goal goal;
    auto& contact = goal.kind.emplace<ContactGoal>();
    contact.obstacle = "pier";
    contact.part = TouchingPart::end_effector;
    contact.z_m = z_m;
    goal.hold_s = 2;
    return goal;
}

Solution first_of(const Problem& problem) {
    SolveOptions options;
    options.stop_at_first_solution = true;
    options.threads = 2;
    return solve(problem, options);
}

double energy_at_j(const Execution& flight, double t_s) {
    const auto row = std::ranges::find_if(flight.rows, [&](const FlightRow& each) { return each.t_s >= t_s; });
    return row->energy_j;
}

}  // namespace

TEST_CASE("hover, touch, hover and touch are one flight, which each variant plans") {
    Problem problem = deck_and_pier();
    problem.uncertainty.reset();
    problem.planner.variant = GENERATE(Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada);
    CAPTURE(name_of(problem.planner.variant));
    const Solution found = first_of(problem);
    REQUIRE(found.status == Status::solved);
    const std::vector<GoalVisit>& visits = found.execution->goals;
    REQUIRE(visits.size() == 4);
    for (const GoalVisit& visit : visits) {
        CHECK(visit.is_met);
    }
    CHECK_FALSE(visits[0].touch);
    CHECK_FALSE(visits[2].touch);
    REQUIRE(visits[1].touch);
    REQUIRE(visits[3].touch);
    CHECK(visits[1].touch->force_n == Approx(5).epsilon(0.2));
    CHECK(visits[3].touch->force_n == Approx(5).epsilon(0.2));
    CHECK(visits[3].touch->touched_s > visits[1].touch->left_s + 8);
    // The plan leaves touches out: the flight lasts longer by both, with the holds of their forces.
    CHECK(found.execution->duration_s > found.plan->duration_s() + touch_hover_s + 2 * 5);
    // What follows a touch is judged as what comes before: the margin is kept, but for the touches themselves.
    CHECK(found.execution->min_clearance_m >= problem.planner.safety_margin_m);
}

TEST_CASE("what is left after a touch begins as the touch leaves the vehicle, with what it took") {
    Problem problem = deck_and_pier();
    problem.uncertainty.reset();
    const Solution found = first_of(problem);
    REQUIRE(found.status == Status::solved);
    const Plan& plan = *found.plan;
    const auto model = make_flight_model(problem);
    const std::vector<std::size_t> ends = hover_ends(*model, plan.reference, goals_of(problem));
    REQUIRE(ends.size() == 3);
    const std::int64_t touched_at = plan.reference[ends[1]].tick;
    const Takeover before = take_over(problem, plan, {}, touched_at - 1);
    const Takeover after = take_over(problem, plan, {}, touched_at);
    CHECK(before.visited.size() == 1);
    CHECK(after.visited.size() == 2);
    const TouchRecord& touch = *found.execution->goals[1].touch;
    CHECK(after.energy_j - before.energy_j >
          energy_at_j(*found.execution, touch.left_s) - energy_at_j(*found.execution, touch.touched_s));
    const Problem next = remaining(after, problem);
    REQUIRE(next.goals_before.size() == 1);
    CHECK_FALSE(may_touch(next.goals_before[0]));
    const Execution rest = execute(*model, start_state(*model, next.start), after.rest.reference, goals_of(next), true);
    CHECK(rest.outcome == Outcome::ok);
    CHECK(rest.goals.back().touch->is_met);
    CHECK(after.energy_j + rest.energy_j == Approx(found.execution->energy_j).epsilon(1e-6));
}

TEST_CASE("a contact may be one of several alternatives, and is touched if the plan ends there") {
    Problem problem = empty_problem();
    const bool is_touch_near = GENERATE(true, false);
    const Goal far = test::configuration_goal(2, 2), near = test::configuration_goal(-3, 7);
    problem.goal.any_of = {is_touch_near ? far : near, touch_of_deck(is_touch_near ? -3 : 1)};
    const Solution found = first_of(problem);
    REQUIRE(found.status == Status::solved);
    const GoalVisit& visit = found.execution->goals.at(0);
    CHECK(visit.is_met);
    CHECK(visit.touch.has_value() == is_touch_near);
    const PlanarPose end = level_at(found.plan->last());
    const PlantModel plant = make_flight_model(problem)->tick().plant;
    CHECK((touch_at(plannable(problem).problem.goal, plant, end) != nullptr) == is_touch_near);
}

TEST_CASE("targets in any order may be contacts, and have alternatives that are") {
    Problem problem = empty_problem();
    problem.planner.max_iterations = 800;
    Goal either;
    either.any_of = {touch_of_pier(2), touch_of_pier(6)};
    problem.targets = {touch_of_deck(1), either, test::configuration_goal(2, 6)};
    problem.return_to = test::configuration_goal(-4, 7);
    const Solution found = solve(problem);
    REQUIRE(found.status == Status::solved);
    REQUIRE(found.order);
    REQUIRE(found.order->visits.size() == 3);
    const std::vector<GoalVisit>& visits = found.execution->goals;
    REQUIRE(visits.size() == 4);
    for (std::size_t i = 0; i < 3; ++i) {
        const Visit& visit = found.order->visits[i];
        CAPTURE(i, visit.target);
        CHECK(visits[i].is_met);
        CHECK(visits[i].touch.has_value() == (visit.target != 2));
        if (visit.target == 1) {
            CHECK(visit.alternative == 1);  // on the way to the others
        }
    }
    CHECK_FALSE(visits[3].touch);
    // Energy that touches take counts.
    problem.energy_budget_j = 0.99 * found.execution->energy_j;
    const Execution again = execute(
        *make_flight_model(problem), start_state(*make_flight_model(problem), problem.start), found.plan->reference,
        goals_of(in_order(plannable(problem).problem, found.order)), true, {}, {}, problem.energy_budget_j);
    CHECK(again.outcome == Outcome::over_budget);
}

TEST_CASE(
    "a list with touches gets a certificate that fresh worlds bear out, and none where its places are too narrow") {
    Problem problem = deck_and_pier();
    problem.planner.max_iterations = 100;
    problem.planner.max_failure_probability = 0.1;
    problem.planner.worlds = 2;  // which the narrow one passes, too
    const bool is_narrow = GENERATE(false, true);
    if (is_narrow) {  // what the vehicle may be off by where it touches from
        test::contact(problem.goals_before[1]).tolerance_m = 0.02;
        problem.planner.max_iterations = 24;
    }
    CAPTURE(is_narrow);
    const Solution found = first_of(problem);
    REQUIRE(found.certificate);
    const Certificate& certificate = *found.certificate;
    CHECK(certificate.is_given == !is_narrow);
    CHECK((found.status == Status::solved) == !is_narrow);
    if (is_narrow) {
        CHECK(certificate.failure_probability.low > 0.1);
        return;
    }
    const auto model = make_flight_model(problem);
    const std::vector<Goal> goals = goals_of(plannable(problem).problem);
    constexpr std::uint64_t fresh_worlds = 12, other_seed = 77;
    std::uint64_t failures = 0;
    for (std::uint64_t index = 1; index <= fresh_worlds; ++index) {
        const FlownWorld world =
            make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, other_seed, index));
        FlightState nominal = start_state(*model, problem.start);
        nominal.world = memory_at_start(world, nominal.plant);
        const std::optional<FlightState> start = hovering_start(*model, nominal, true, {&world});
        REQUIRE(start);
        failures +=
            execute(*model, *start, found.plan->reference, goals, true, {&world}).outcome == Outcome::ok ? 0 : 1;
    }
    CHECK(failure_interval(failures, fresh_worlds, 0.98).low <= certificate.max_failure_probability);
}
