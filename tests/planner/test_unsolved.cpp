#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "searched_problems.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("rejections are counted by cause") {
    struct Provoked {
        const char* cause;
        std::function<void(Problem&)> provoke;
    };
    const Provoked all[] = {
        {"collision", [](Problem& p) { p = test::slit_problem(); }},
        {"flyable_area", [](Problem& p) { p.aero.min_distance_radii = 4; }},
        {"saturation", [](Problem& p) { p.robot.rotors.max_thrust_n = 4.95 * 9.80665 / 4 * 1.02; }},
        {"tracking", [](Problem& p) { test::gains_of(p.robot).max_tilt_rad = 0.01; }},
        {"bounds",
         [](Problem& p) {
             p.start.at[plane::x] = p.bounds.x_low_m + 0.3;
             p.start.velocity[plane::x] = -0.9;  // it cannot but overshoot the bound
         }},
        {"arm_limits",
         [](Problem& p) {
             test::limit_arm(p.robot, -3, test::quarter_turn + 0.05);
             p.start.at[plane::arm] = test::quarter_turn;
             p.start.velocity[plane::arm] = 0.7;  // it cannot but overshoot the limit
         }},
        {"goal_missed",
         [](Problem& p) {
             p = test::with_place(3, 4.3);  // where the ceiling lifts the vehicle, and nothing integrates the error
             test::configuration(p.goal).tolerance_m = 0.01;
             test::gains_of(p.robot).position_ki = 0;
         }},
    };
    for (const auto& [cause, provoke] : all) {
        CAPTURE(cause);
        Problem problem = test::ceiling_problem();
        provoke(problem);
        problem.planner.max_iterations = 60;
        const SearchRecord& record = solve(problem).planning;
        CHECK(record.rejected.at(cause) > 0);
        CHECK(record.rejected.size() == 10);
    }
}

TEST_CASE("a search without a plan says how near it came and what stopped it") {
    const Solution walled = solve(test::slit_problem());
    CHECK(walled.status != Status::solved);
    REQUIRE(walled.nearest_approach_m);
    CHECK(*walled.nearest_approach_m > 0.15);  // not beyond the wall, 0.15 m thick on this side
    REQUIRE(walled.obstruction);
    CHECK(walled.obstruction->cause == "collision");
    CHECK(walled.obstruction->at[plane::x] < 0);  // touching the wall from the side of the start

    const Solution sucked_in = solve(right_under_the_ceiling());
    CHECK(sucked_in.status != Status::solved);
    REQUIRE(sucked_in.obstruction);
    CHECK(sucked_in.obstruction->goal_distance_m < 0.5);

    const Solution solved = solve(test::ceiling_problem());
    REQUIRE(solved.status == Status::solved);
    CHECK_FALSE(solved.nearest_approach_m);
    CHECK_FALSE(solved.obstruction);
}

TEST_CASE("the obstacles that stop edges are counted by name, in every variant") {
    for (const Variant variant : variants) {
        CAPTURE(name_of(variant));
        Problem problem = with(variant, test::slit_problem());
        problem.planner.max_iterations = 200;
        problem.obstacles.back().name = "";
        const Solution solution = solve(problem);
        const auto& stopped_by = solution.planning.stopped_by;
        CHECK(stopped_by.contains("wall"));
        CHECK(stopped_by.contains("environment.obstacles[3]"));
        std::uint64_t sum = 0;
        for (const auto& [obstacle, count] : stopped_by) {
            sum += count;
        }
        CHECK(sum <= solution.planning.rejected.at("collision"));  // which counts samples, too
        REQUIRE(solution.obstruction);
        REQUIRE(solution.obstruction->obstacles.size() == 1);
        CHECK(stopped_by.contains(solution.obstruction->obstacles.front()));
    }
    Problem lines = with(Variant::mp_arm, test::slit_problem());
    lines.planner.algorithm = "rrt-connect";
    CHECK(solve(lines).planning.stopped_by.contains("wall"));
}

TEST_CASE("a scene that closes the plane is told at once, with the obstacles that do") {
    for (const Variant variant : variants) {
        CAPTURE(name_of(variant));
        const Solution solution = solve(with(variant, test::walled_problem()));
        CHECK(solution.status == Status::none);
        CHECK_FALSE(solution.plan);
        CHECK(solution.planning.iterations == 0);
        REQUIRE(solution.obstruction);
        CHECK(solution.obstruction->cause == "closed_plane");
        // The wall ends with the bounds. A body's middle may be above its centre of mass, and there the ceiling is.
        CHECK(solution.obstruction->obstacles == std::vector<std::string>{"ceiling", "wall"});
    }
    Problem several = test::walled_problem();
    several.goals_before = {test::tip_goal(-3, 4)};
    CHECK(solve(several).missed_goal == std::optional<std::size_t>(2));
    several.targets = {test::tip_goal(3, 4), test::tip_goal(4, 3)};
    several.goals_before.clear();
    several.goal = {};
    const Solution none = solve(several);
    REQUIRE(none.order);
    CHECK(none.order->visits.empty());
    CHECK(none.order->left_out.size() == 2);
    CHECK(none.planning.iterations == 0);
}

TEST_CASE("where every plan was discarded, the direct flight is what stopped the search") {
    Problem problem = right_under_the_ceiling();
    const planning::SearchResult result = solve_deceived(problem, {});
    CHECK(result.found.status != Status::solved);
    CHECK(result.record.rejected.at("direct_flight") > 0);
    REQUIRE(result.found.obstruction);
    CHECK(result.found.obstruction->cause == "direct_flight");
    CHECK(result.found.obstruction->at[plane::z] > 4);
}
