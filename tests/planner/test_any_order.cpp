#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/leg_table.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;

namespace {

Goal place(double x_m, double z_m) {
    Goal goal = test::configuration_goal(x_m, z_m);
    goal.hold_s = 1;
    return goal;
}

/// From (-4, 2) to places on a line, which stand in the file in a bad order.
Problem line_of_targets(Variant variant) {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = variant;
    problem.planner.max_iterations = variant == Variant::mp_arm ? 6000 : 600;
    problem.goal = {};
    problem.targets = {place(4, 2), place(-2, 2.5), place(2, 2), place(0, 2.5)};
    return problem;
}

std::vector<std::size_t> targets_of(const Solution& solution) {
    std::vector<std::size_t> targets;
    for (const Visit& visit : solution.order->visits) {
        targets.push_back(visit.target);
    }
    return targets;
}

}  // namespace

TEST_CASE("targets in any order are visited in the order that costs least, each held, in one flight") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada}) {
        CAPTURE(name_of(variant));
        const Solution solution = solve(line_of_targets(variant));
        REQUIRE(solution.status == Status::solved);
        CHECK(targets_of(solution) == std::vector<std::size_t>{1, 3, 2, 0});
        CHECK(solution.order->left_out.empty());
        CHECK(solution.order->is_best);
        CHECK(solution.execution->outcome == Outcome::ok);
        REQUIRE(solution.execution->goals.size() == 4);
        CHECK(solution.execution->rows.back().q[0] == Approx(4).margin(0.1));
        CHECK(solution.planning.first_solution_wall_s);
        CHECK(solution.planning.iterations <= (variant == Variant::mp_arm ? 6000 : 600));
    }
}

TEST_CASE("progress of targets in any order counts the work of all searches, and tells of legs") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.planner.max_iterations = 6000;
    SolveOptions options;
    Progress last;
    bool has_told_of_legs = false;
    options.on_progress = [&](const Progress& now) {
        CHECK(now.iterations >= last.iterations);
        CHECK(now.nodes >= last.nodes);
        CHECK(now.rejected >= last.rejected);
        CHECK(now.goals == 4);
        has_told_of_legs = has_told_of_legs || now.legs.value_or(0) > 0;
        last = now;
    };
    const Solution solution = solve(problem, options);
    CHECK(has_told_of_legs);
    CHECK(last.nodes > 0);
    std::uint64_t rejected = 0;
    for (const auto& [cause, count] : solution.planning.rejected) {
        rejected += count;
    }
    CHECK(last.rejected <= rejected);
}

TEST_CASE("targets in any order come out the same byte by byte on one thread and on two") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.return_to = place(-4, 2);
    SolveOptions two;
    two.threads = 2;
    const Solution a = solve(problem);
    const Solution b = solve(problem, two);
    CHECK(a.order == b.order);
    CHECK(a.cost == b.cost);
    REQUIRE(a.execution);
    CHECK(test::same_bytes(*a.execution, *b.execution));
    CHECK(a.execution->goals.size() == 5);
    CHECK(a.execution->rows.back().q[0] == Approx(-4).margin(0.1));
}

TEST_CASE("of the alternatives of a target the flight takes the one on its way") {
    Problem problem = line_of_targets(Variant::mp_arm_da);
    Goal either;
    either.any_of = {place(-4, 4), place(1, 2.5)};
    problem.targets = {place(3, 2), either};
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.order->visits == std::vector<Visit>{{1, 1}, {0, std::nullopt}});
    CHECK(solution.execution->outcome == Outcome::ok);
}

TEST_CASE("an energy budget is kept: targets for which it is not enough are left out, with what they would take") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.return_to = place(-4, 2);
    problem.planner.max_iterations = 2000;
    const Solution all = solve(problem);
    REQUIRE(all.status == Status::solved);
    problem.energy_budget_j = 0.6 * all.execution->energy_j;
    for (const Variant variant : {Variant::mp_arm_ada, Variant::mp_arm_da}) {
        CAPTURE(name_of(variant));
        problem.planner.variant = variant;
        const Solution some = solve(problem);
        REQUIRE(some.status == Status::solved);
        CHECK(some.execution->outcome == Outcome::ok);
        CHECK(some.execution->energy_j <= *problem.energy_budget_j);
        CHECK_FALSE(some.order->visits.empty());
        REQUIRE_FALSE(some.order->left_out.empty());
        CHECK(some.order->visits.size() + some.order->left_out.size() == 4);
        // The farthest one and the return from there take more than 0.6 of what the whole does.
        CHECK(some.order->left_out.front().target == 0);
        for (const LeftOutTarget& each : some.order->left_out) {
            CHECK(each.reason == LeftOutReason::energy_budget);
            REQUIRE(each.energy_j);
            CHECK(*each.energy_j > 0.95 * *problem.energy_budget_j);
        }
    }
    problem.energy_budget_j = 1;
    const Solution none = solve(problem);
    CHECK(none.status != Status::solved);
    CHECK_FALSE(none.plan);
    REQUIRE(none.order->left_out.size() == 4);
    CHECK(none.order->left_out[2].reason == LeftOutReason::energy_budget);
}

TEST_CASE("who asks for the first plan alone gets no more under a limit of energy") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.planner.max_iterations = 6000;
    const Solution without_limit = solve(problem);
    REQUIRE(without_limit.status == Status::solved);
    problem.energy_budget_j = 1.5 * without_limit.execution->energy_j;
    SolveOptions first_only;
    first_only.stop_at_first_solution = true;
    const Solution first = solve(problem, first_only);
    REQUIRE(first.status == Status::solved);
    CHECK(first.order->left_out.empty());
    CHECK(first.execution->energy_j <= *problem.energy_budget_j);
    CHECK(first.planning.improvements.size() == 1);
    const Solution best = solve(problem);
    CHECK(best.planning.improvements.size() > 1);
    CHECK(best.planning.iterations > first.planning.iterations);
}

TEST_CASE("progress tells planned costs of targets in any order, never an executed one") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.planner.max_iterations = 6000;
    SolveOptions options;
    std::vector<double> told;
    options.on_progress = [&](const Progress& now) {
        if (now.best_cost && (told.empty() || told.back() != *now.best_cost)) {
            told.push_back(*now.best_cost);
        }
    };
    const Solution solution = solve(problem, options);
    REQUIRE(solution.status == Status::solved);
    REQUIRE_FALSE(told.empty());
    for (const Improvement& each : solution.planning.improvements) {
        REQUIRE(each.flown_cost);
        CHECK(std::ranges::find(told, *each.flown_cost) == told.end());
    }
}

TEST_CASE("a target behind a wall is left out, and the flight to the others is not called solved") {
    Problem problem = line_of_targets(Variant::mp_arm_da);
    problem.obstacles.push_back(test::box("wall", {0.3, 8, 5}, {3, 0, 2.5}));
    problem.planner.max_iterations = 1200;
    const Solution solution = solve(problem);
    CHECK(solution.status == Status::approximate);
    REQUIRE(solution.order->left_out.size() == 1);
    CHECK(solution.order->left_out[0] == LeftOutTarget{0, LeftOutReason::no_flight, std::nullopt});
    CHECK(targets_of(solution) == std::vector<std::size_t>{1, 3, 2});
    REQUIRE(solution.execution);
    CHECK(solution.execution->outcome == Outcome::ok);
    CHECK(solution.execution->goals.size() == 3);
}

TEST_CASE("an interrupted search for an order has the flight that it found first") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.planner.max_iterations = 3000;
    std::stop_source stop;
    SolveOptions options;
    options.stop = stop.get_token();
    options.on_plan = [&](const FoundPlan&) { stop.request_stop(); };
    const Solution solution = solve(problem, options);
    CHECK(solution.interrupted);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.order->visits.size() == 4);
    CHECK(solution.planning.iterations < 1000);
}

TEST_CASE("flights in worlds that take more energy than they may count against the certificate") {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.targets = {place(2, 2), place(0, 2.5)};
    problem.planner.max_iterations = 1000;
    problem.planner.worlds = 2;
    problem.planner.max_failure_probability = 0.2;
    problem.uncertainty.emplace();
    problem.uncertainty->mass_scale = Spread::of_sd(0.05);
    const Solution all = solve(problem);
    REQUIRE(all.status == Status::solved);
    // Heavier vehicles take more: in half of the worlds this is not enough for both.
    problem.energy_budget_j = 1.002 * all.execution->energy_j;
    const Solution some = solve(problem);
    REQUIRE(some.status == Status::solved);
    CHECK(some.order->visits.size() == 1);
    CHECK(some.certificate->is_given);
    problem.planner.certify = false;  // in the nominal world it is enough
    const Solution nominal = solve(problem);
    REQUIRE(nominal.status == Status::solved);
    CHECK(nominal.order->visits.size() == 2);
    CHECK_FALSE(nominal.certificate);
}

namespace {

/// Targets with a way back, in worlds, with plenty of energy and only time to end the search.
Problem timed_targets() {
    Problem problem = line_of_targets(Variant::mp_arm_ada);
    problem.return_to = place(-4, 2);
    problem.energy_budget_j = 1e6;
    problem.planner.worlds = 2;
    problem.planner.max_failure_probability = 0.2;
    problem.uncertainty.emplace();
    problem.uncertainty->mass_scale = Spread::of_sd(0.02);
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 1000;
    return problem;
}

}  // namespace

TEST_CASE("under a time limit the first flight through targets is that of the list in their order") {
    const Problem problem = timed_targets();
    SolveOptions first_only;
    first_only.stop_at_first_solution = true;
    const Solution any_order = solve(problem, first_only);
    REQUIRE(any_order.status == Status::solved);
    REQUIRE(any_order.order);
    CHECK(any_order.order->visits.size() == 4);
    REQUIRE(any_order.certificate);
    CHECK(any_order.certificate->is_given);
    Problem list = in_order(problem, any_order.order);
    list.energy_budget_j.reset();
    const Solution in_turn = solve(list, first_only);
    REQUIRE(in_turn.status == Status::solved);
    CHECK(test::same_bytes(*in_turn.plan, *any_order.plan));
    CHECK(any_order.planning.iterations == in_turn.planning.iterations);
    CHECK(any_order.certificate->worlds == in_turn.certificate->worlds);
}

TEST_CASE("a search for targets that the time ends in the middle of worlds says so, and in how many it was") {
    Problem problem = timed_targets();
    problem.planner.time_limit_s = 6;
    problem.planner.max_failure_probability = 1e-4;  // which takes tens of thousands of worlds for each target
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.spread != nullptr) {
            (*problem.uncertainty).*key.spread = {};  // all worlds are the nominal one, and none fails
        }
    }
    const Solution solution = solve(problem);
    CHECK(solution.status == Status::approximate);
    CHECK(solution.planning.wall_s == Approx(6).margin(3));
    REQUIRE(solution.obstruction);
    CHECK(solution.obstruction->cause == unfinished_certificate);
    CHECK(solution.missed_goal == std::optional<std::size_t>(1));
    REQUIRE(solution.certificate);
    CHECK_FALSE(solution.certificate->is_given);
    CHECK(solution.certificate->worlds > 0);
    CHECK_FALSE(solution.certificate->is_refused);
    CHECK(solution.planning.candidates.unfinished > 0);
    CHECK(solution.planning.rejected.at("direct_flight") == solution.planning.candidates.rejected());
    CHECK(solution.planning.candidates.failed_certificate == 0);
    REQUIRE(solution.order);
    CHECK(solution.order->visits.size() == 4);
    CHECK(solution.order->left_out.empty());
}

TEST_CASE("under a time limit a target behind a wall is left out, and the flight to the others is found") {
    Problem problem = line_of_targets(Variant::mp_arm_da);
    problem.obstacles.push_back(test::box("wall", {0.3, 8, 5}, {3, 0, 2.5}));
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 8;
    const Solution solution = solve(problem);
    CHECK(solution.status == Status::approximate);
    REQUIRE(solution.order->left_out.size() == 1);
    CHECK(solution.order->left_out[0] == LeftOutTarget{0, LeftOutReason::no_flight, std::nullopt});
    CHECK(solution.order->visits.size() == 3);
    REQUIRE(solution.execution);
    CHECK(solution.execution->outcome == Outcome::ok);
    CHECK(solution.planning.wall_s > 7);  // the search does not end before its time
}

TEST_CASE("legs that were searched for in vain are put off, given up, or searched for again") {
    Problem problem = line_of_targets(Variant::mp_arm_da);
    problem.obstacles.push_back(test::box("wall", {0.3, 8, 5}, {3, 0, 2.5}));  // before target 0
    const std::shared_ptr<const FlightModel> flight = make_flight_model(problem);
    const planning::PlannerModel model{problem.planner.variant, flight, nullptr};
    const SolveOptions options;
    planning::LegTable table(problem, model, options);
    PlannerSettings settings = problem.planner;
    settings.max_iterations = 8;
    const planning::SearchBudget budget(settings);
    const std::size_t outside = table.estimates().outside();
    const double bound = table.estimates().leg(outside, 0).cost;
    const auto cost = [&] { return table.estimates().leg(outside, 0).cost; };
    CHECK_FALSE(table.search_on());
    for (int search = 0; search < 2; ++search) {
        CHECK(cost() == bound);
        CHECK(table.fly(outside, 0, budget, 10).iterations > 0);
    }
    CHECK(std::isinf(cost()));
    CHECK(table.fly(outside, 0, budget, 10).iterations == 0);
    CHECK(table.search_on());
    CHECK(cost() == bound);
    CHECK(table.fly(outside, 0, budget, 10).iterations > 0);
    CHECK(std::isinf(cost()));

    CHECK(std::isfinite(table.estimates().leg(1, 3).cost));
    table.put_off(3);
    CHECK(std::isinf(table.estimates().leg(1, 3).cost));
    CHECK(std::isinf(table.estimates().leg(outside, 3).cost));
    table.give_up(outside, 0);
    CHECK(table.search_on());
    CHECK(std::isfinite(table.estimates().leg(1, 3).cost));
    CHECK(std::isinf(cost()));  // it is given up
}
