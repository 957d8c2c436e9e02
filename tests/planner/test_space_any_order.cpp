#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <vector>

#include "downwash/planner/leg_table.hpp"
#include "downwash/planner/order_comparison.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;
using planning::Space;

namespace {

SpaceGoal place(double x_m, double y_m, double z_m) {
    SpaceConfigurationGoal at;
    at.x_m = x_m;
    at.y_m = y_m;
    at.z_m = z_m;
    return {at, 1, {}};
}

SpaceProblem girder_survey() {
    return read_space_problem(DOWNWASH_PROBLEMS "/space/girder_survey.yaml");
}

/// From (-3, -2, 3) in open air to places on a line, which stand in the file in a bad order.
SpaceProblem line_of_targets(Variant variant = Variant::mp_arm_da) {
    SpaceProblem problem = girder_survey();
    problem.obstacles.clear();
    problem.aero.enabled = false;
    problem.uncertainty.reset();
    problem.planner.variant = variant;
    problem.planner.max_iterations = 400;
    problem.goals = {place(3, -2, 3), place(-1.5, -2, 3.5), place(1.5, -2, 3), place(0, -2, 3.5)};
    problem.return_to.reset();
    problem.energy_budget_j.reset();
    return problem;
}

SpaceSearchResult solved(const SpaceProblem& problem, int threads = 1) {
    SpaceSolveOptions options;
    options.threads = threads;
    return solve(std::make_shared<const SpaceProblemModel>(problem), options);
}

std::vector<std::size_t> targets_of(const SpaceSearchResult& result) {
    std::vector<std::size_t> targets;
    for (const Visit& visit : result.order->visits) {
        targets.push_back(visit.target);
    }
    return targets;
}

bool is_same(const SpacePlan& a, const SpacePlan& b) {
    return std::equal(a.reference.begin(), a.reference.end(), b.reference.begin(), b.reference.end(),
                      [](const SpaceKnot& x, const SpaceKnot& y) { return x.tick == y.tick && x.point == y.point; });
}

}  // namespace

TEST_CASE("targets in space are visited in the order that costs least, each held, in one flight") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da}) {
        CAPTURE(name_of(variant));
        const SpaceProblem problem = line_of_targets(variant);
        const SpaceSearchResult found = solved(problem);
        REQUIRE(found.status == Status::solved);
        REQUIRE(found.order);
        CHECK(targets_of(found) == std::vector<std::size_t>{1, 3, 2, 0});
        CHECK(found.order->left_out.empty());
        CHECK(found.order->is_best);
        CHECK(found.order->legs > 4);
        CHECK(found.planning.iterations <= 400);
        REQUIRE(found.execution->goals.size() == 4);
        CHECK(std::ranges::all_of(found.execution->goals, &SpaceGoalVisit::is_met));
        // The plan tells the order by itself, too: the rule for goals in any order finds the same hovers.
        const SpaceFlight flown = SpaceProblemModel(problem).execute(*found.plan);
        CHECK(flown.outcome == Outcome::ok);
        CHECK(flown.energy_j == found.execution->energy_j);
    }
}

TEST_CASE("targets in space with a way back come out the same on one thread and on two") {
    SpaceProblem problem = line_of_targets();
    problem.return_to = place(-3, -2, 3);
    const SpaceSearchResult one = solved(problem, 1);
    const SpaceSearchResult two = solved(problem, 2);
    REQUIRE(one.status == Status::solved);
    REQUIRE(two.plan);
    CHECK(one.order == two.order);
    CHECK(is_same(*one.plan, *two.plan));
    CHECK(one.cost == two.cost);
    CHECK(one.planning.edges_simulated == two.planning.edges_simulated);
    CHECK(one.execution->goals.size() == 5);
    CHECK(one.execution->rows.back().motion.position_m[0] == Approx(-3).margin(0.1));
    // With a place to return to, the order has to be told.
    const SpaceProblemModel in_file_order(problem), in_found_order(in_order(problem, one.order));
    CHECK(in_file_order.execute(*one.plan).outcome == Outcome::goal_missed);
    CHECK(in_found_order.execute(*one.plan).outcome == Outcome::ok);
}

TEST_CASE("of the alternatives of a target in space the flight takes the one on its way") {
    SpaceProblem problem = line_of_targets();
    SpaceGoal either;
    either.any_of = {place(-3, 2, 3), place(0.5, -2, 3)};
    problem.goals = {place(3, -2, 3), either};
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(found.order->visits == std::vector<Visit>{{1, 1}, {0, std::nullopt}});
}

TEST_CASE("an energy budget is kept in space: targets for which it is not enough are left out") {
    SpaceProblem problem = line_of_targets();
    problem.return_to = place(-3, -2, 3);
    problem.planner.max_iterations = 1000;
    const SpaceSearchResult all = solved(problem);
    REQUIRE(all.status == Status::solved);
    problem.energy_budget_j = 0.6 * all.execution->energy_j;
    const SpaceSearchResult some = solved(problem);
    REQUIRE(some.status == Status::solved);
    CHECK(some.execution->energy_j <= *problem.energy_budget_j);
    CHECK_FALSE(some.order->visits.empty());
    REQUIRE_FALSE(some.order->left_out.empty());
    CHECK(some.order->left_out.front().target == 0);  // the farthest one
    for (const LeftOutTarget& each : some.order->left_out) {
        CHECK(each.reason == LeftOutReason::energy_budget);
        CHECK(each.energy_j.value_or(0) > 0.95 * *problem.energy_budget_j);
    }
    problem.energy_budget_j = 1;
    const SpaceSearchResult none = solved(problem);
    CHECK(none.status != Status::solved);
    CHECK(none.order->left_out.size() == 4);
}

TEST_CASE("a first flight through many targets in space has enough iterations for each leg") {
    SpaceProblem problem = line_of_targets();
    problem.goals.clear();
    for (int i = 0; i < 16; ++i) {
        problem.goals.push_back(place(-2.5 + 0.3 * i, i % 2 == 0 ? -2 : -1.5, 3));
    }
    problem.return_to = place(-3, -2, 3);
    problem.planner.max_iterations = 480;
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(found.order->visits.size() == 16);
    // The flight in the order that looks best was found at once: there is none before the comparison otherwise.
    REQUIRE_FALSE(found.planning.improvements.empty());
    CHECK(found.planning.improvements.front().iteration <= 17 * 24);
}

/// Seven targets on each side of a wall that can be passed at one end only, where the flight begins.
SpaceProblem both_sides_of_a_wall() {
    SpaceProblem problem = line_of_targets();
    problem.bounds = {{-5, -5, 1}, {5, 1, 5}};
    problem.obstacles.push_back({"wall", Box{{8, 0.1, 6}}, {-1.2, -2, 3}});
    problem.start.position_m = {4.4, -2, 3};
    problem.goals.clear();
    for (int i = 0; i < 7; ++i) {
        for (const double side : {-1.0, 1.0}) {
            problem.goals.push_back(place(2.1 - 0.9 * i, -2 + 1.1 * side, 3));
        }
    }
    problem.planner.max_iterations = 1500;
    return problem;
}

TEST_CASE("the order of many targets in space knows which ways around obstacles are long") {
    const SpaceProblem problem = both_sides_of_a_wall();
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    const std::vector<std::size_t> order = targets_of(found);
    REQUIRE(order.size() == 14);
    // One side after the other, and each from the open end: straight ways in free air would cross the wall at its far
    // end, and come to the second side from there.
    CHECK(order[0] < 2);
    CHECK(order[7] < 2);
    for (std::size_t i = 1; i < order.size(); ++i) {
        CHECK((i == 7 || order[i] % 2 == order[i - 1] % 2));
    }
    CHECK_FALSE(found.order->is_best);  // nothing proves it
}

TEST_CASE("what is expected of legs in space proves no order best") {
    SpaceProblem problem = both_sides_of_a_wall();
    problem.goals.resize(6);
    const planning::PlannerModelOf<Space> model(problem.planner.variant,
                                                std::make_shared<const SpaceProblemModel>(problem), nullptr);
    const SpaceSolveOptions options;
    planning::LegTableOf<Space> table(problem, model, options);
    planning::OrderComparisonOf<Space> comparison(table, [] { return false; });
    // Nothing is flown yet: straight ways through the wall are short.
    const planning::PlaceOrder expected = comparison.chosen();
    REQUIRE(expected.places.size() == 6);
    CHECK(expected.cost == comparison.likely().cost);
    CHECK(best_order(table.lower_bounds()).cost < expected.cost);
    CHECK_FALSE(expected.is_best);
    static_cast<void>(comparison.compare(planning::SearchBudget(problem.planner)));
    const planning::PlaceOrder flown = comparison.chosen();
    CHECK(flown.places.size() == 6);
    CHECK(flown.cost == order_of(table.flown_costs(), flown.places).cost);
}

TEST_CASE("lower bounds of legs in space are never above what ways around obstacles are expected to take") {
    const SpaceProblem problem = both_sides_of_a_wall();
    const planning::PlannerModelOf<Space> model(problem.planner.variant,
                                                std::make_shared<const SpaceProblemModel>(problem), nullptr);
    const SpaceSolveOptions options;
    const planning::LegTableOf<Space> table(problem, model, options);
    const std::size_t outside = table.estimates().outside();
    for (std::size_t from = 0; from <= outside; ++from) {
        for (std::size_t to = 0; to < outside; ++to) {
            if (from != to) {
                CHECK(table.at_least().leg(from, to).cost <= table.estimates().leg(from, to).cost);
            }
        }
    }
    // Along the wall straight motion is all that it takes; through it, at the far end, it takes many times as much.
    CHECK(table.estimates().leg(10, 12).cost < 2 * table.at_least().leg(10, 12).cost);
    CHECK(table.estimates().leg(12, 13).cost > 2.5 * table.estimates().leg(10, 12).cost);
    CHECK(table.expected(12, 13).corners.size() > 2);
    CHECK(table.expected(10, 12).corners.size() == 1);  // the place itself
}

TEST_CASE("a target in a closed box in space is left out, and the flight to the others is not called solved") {
    SpaceProblem problem = line_of_targets();
    const auto wall = [&](const char* name, Vector3 size_m, Vector3 center_m) {
        problem.obstacles.push_back({name, Box{size_m}, center_m});
    };
    wall("left", {2, 0.1, 2}, {3, -1, 3});
    wall("front", {0.1, 2, 2}, {2.1, -2, 3});
    problem.goals[2] = place(0.8, -2, 3);  // clear of it
    wall("top", {2, 2, 0.1}, {3, -2, 4});
    wall("bottom", {2, 2, 0.1}, {3, -2, 2});
    problem.planner.max_iterations = 600;
    const SpaceSearchResult found = solved(problem);
    CHECK(found.status == Status::approximate);
    REQUIRE(found.order->left_out.size() == 1);
    CHECK(found.order->left_out[0] == LeftOutTarget{0, LeftOutReason::no_flight, std::nullopt});
    REQUIRE(found.execution);
    CHECK(found.execution->outcome == Outcome::ok);
    CHECK(found.execution->goals.size() == 3);
}

TEST_CASE("flights in worlds in space that take more energy than they may count against the certificate") {
    SpaceProblem problem = line_of_targets();
    problem.goals = {place(1.5, -2, 3), place(0, -2, 3.5)};
    problem.planner.worlds = 2;
    problem.planner.max_failure_probability = 0.2;
    problem.uncertainty.emplace();
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.spread != nullptr) {
            (*problem.uncertainty).*key.spread = {};
        }
    }
    problem.uncertainty->mass_scale = Spread::of_sd(0.05);
    const SpaceSearchResult all = solved(problem);
    REQUIRE(all.status == Status::solved);
    REQUIRE(all.certificate);
    CHECK(all.certificate->is_given);
    CHECK(all.order->visits.size() == 2);
    // Heavier vehicles take more: in half of the worlds this is not enough for both.
    problem.energy_budget_j = 1.002 * all.execution->energy_j;
    const SpaceSearchResult some = solved(problem);
    REQUIRE(some.status == Status::solved);
    CHECK(some.order->visits.size() == 1);
    CHECK(some.certificate->is_given);
}

TEST_CASE("the order of five views of a girder is nearly the best of all orders by legs of another search") {
    SpaceProblem problem = girder_survey();
    problem.uncertainty.reset();
    problem.planner.variant = Variant::mp_arm_da;
    problem.planner.max_iterations = 2500;
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(found.order->visits.size() == 5);
    CHECK(found.execution->energy_j <= *problem.energy_budget_j);

    // Every leg is searched for with the same effort, and every order is tried.
    const planning::PlannerModelOf<Space> model(problem.planner.variant,
                                                std::make_shared<const SpaceProblemModel>(problem), nullptr);
    const SpaceSolveOptions options;
    planning::LegTableOf<Space> table(problem, model, options);
    PlannerSettings settings = problem.planner;
    settings.max_iterations = 40;
    const planning::SearchBudget budget(settings);
    const std::size_t outside = table.estimates().outside();
    for (std::size_t i = 0; i <= outside; ++i) {
        const std::size_t from = i == 0 ? outside : i - 1;  // the start first: legs begin where others end
        for (std::size_t to = 0; to <= outside; ++to) {
            for (int search = 0; search < 3 && !table.is_known(from, to); ++search) {
                static_cast<void>(table.fly(from, to, budget, 1e9));
            }
        }
    }
    std::vector<std::size_t> order(5);
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> all;
    do {
        all.push_back(order_of(table.flown_costs(), order).cost);
    } while (std::ranges::next_permutation(order).found);
    std::ranges::sort(all);
    REQUIRE(std::isfinite(all.front()));
    const std::vector<std::size_t> targets = targets_of(found);  // places: no target has alternatives
    const double found_cost = order_of(table.flown_costs(), targets).cost;
    CHECK(found_cost <= 1.1 * all.front());  // legs of two short searches differ by some percent
    CHECK(found_cost < all[all.size() / 10]);
}
