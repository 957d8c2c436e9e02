#include <catch2/catch.hpp>

#include "../support/error_of.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/simulation/execution.hpp"

using namespace downwash;

namespace {

/// Two places one after the other, far from everything.
Problem two_goals() {
    Problem problem = test::with_place(2, 2.5);
    problem.start.at[plane::z] = 2.5;
    problem.goals_before = {problem.goal};
    problem.goal.kind = ConfigurationGoal{-1, 3, {}, 0.2};
    problem.goals_before[0].hold_s = problem.goal.hold_s = 1;
    problem.planner.max_iterations = 200;
    return problem;
}

}  // namespace

TEST_CASE(
    "what is left of a problem after a moment of a plan starts where its flight is, without the goals of before") {
    const Problem problem = two_goals();
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    const Plan& plan = *solution.plan;
    const auto model = make_flight_model(problem);
    const std::vector<std::size_t> ends = hover_ends(*model, plan.reference, goals_of(problem));
    REQUIRE(ends.size() == 1);
    const std::int64_t first_end = plan.reference[ends[0]].tick;

    for (const std::int64_t tick : {std::int64_t{0}, first_end / 2, first_end, first_end + 60}) {
        CAPTURE(tick);
        const Takeover from = take_over(problem, plan, {}, tick);
        CHECK(from.visited.size() == (tick < first_end ? 0 : 1));
        CHECK(from.left.size() + from.visited.size() == 2);
        const FlightRow& row = solution.execution->rows[static_cast<std::size_t>(tick)];
        CHECK(from.start.at[plane::x] == Approx(row.q[0]).margin(1e-9));  // a quintic cut in two has other last bits
        CHECK(from.start.pitch_rad == Approx(row.q[2]).margin(1e-9));
        CHECK(from.start.velocity[plane::z] == Approx(row.u[1]).margin(1e-9));
        CHECK(from.energy_j == Approx(row.energy_j).epsilon(1e-9));
        CHECK(from.rest.reference.front().point == plan.at(tick));
        CHECK(same_reference_s(plan.rest_after(tick), from.rest) == from.rest.duration_s());
        const Problem next = remaining(from, problem);
        CHECK(next.goals_before.size() == from.left.size() - 1);
        // The rest of the plan is a plan of what is left.
        const Execution rest =
            execute(*model, start_state(*model, next.start), from.rest.reference, goals_of(next), true);
        CHECK(rest.outcome == Outcome::ok);
    }
    CHECK(same_reference_s(plan, plan.rest_after(first_end)) < 1);
}

TEST_CASE("targets that were visited are left out, and what was spent is no longer in the budget") {
    Problem problem = two_goals();
    Takeover from;
    from.rest.tick_s = 1 / problem.robot.controller.rate_hz;
    from.energy_j = 300;
    problem.targets = {problem.goal, problem.goals_before[0]};
    problem.goals_before.clear();
    problem.energy_budget_j = 1000;
    from.visited = {problem.targets[1]};
    Problem next = remaining(from, problem);
    REQUIRE(next.targets.size() == 1);
    CHECK(std::get<ConfigurationGoal>(next.targets[0].kind).x_m == -1);
    CHECK(*next.energy_budget_j == 700);

    problem.energy_budget_j = 300;
    CHECK_THAT(test::error_of([&] { static_cast<void>(remaining(from, problem)); }),
               Catch::Contains("goal.energy_budget_j: is spent before this moment: the plan has taken 300 J"));
    problem.energy_budget_j.reset();
    from.visited = problem.targets;
    CHECK_THAT(test::error_of([&] { static_cast<void>(remaining(from, problem)); }),
               Catch::Contains("has no target that was not visited before"));
    problem.return_to = two_goals().goal;
    next = remaining(from, problem);
    CHECK(next.targets.empty());
    CHECK_FALSE(next.return_to);
    CHECK(std::get<ConfigurationGoal>(next.goal.kind).z_m == 3);
    problem.robot.controller.rate_hz = 250;
    CHECK_THAT(test::error_of([&] { static_cast<void>(remaining(from, problem)); }),
               Catch::Contains("robot.controller.rate_hz: is 250: expected 100"));
}
