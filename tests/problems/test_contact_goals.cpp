#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "../support/error_of.hpp"
#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/touch_places.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// The ceiling problem, its goal to press against an obstacle.
Problem contact_problem(const std::string& obstacle, TouchingPart part) {
    Problem problem = ceiling_problem();
    problem.goal = Goal{};
    auto& contact = problem.goal.kind.emplace<ContactGoal>();
    contact.obstacle = obstacle;
    contact.part = part;
    problem.goal.hold_s = 4;
    problem.aero.min_distance_radii = 0.05;
    return problem;
}

std::string only_error(const Problem& problem) {
    const std::vector<KeyError> errors = problem_errors(problem);
    REQUIRE(errors.size() == 1);
    return errors.front().key + ": " + errors.front().message;
}

}  // namespace

TEST_CASE("a frame touches a ceiling from places below it, the length of the robot's top away from its edges") {
    Problem problem = contact_problem("ceiling", TouchingPart::frame);
    problem.obstacles.back() = box("ceiling", {6, 8, 1}, {0, 0, 5.5});
    const Problem placed = with_touches(problem);
    REQUIRE(placed.goal.any_of.size() > 5);
    REQUIRE(placed.goal.any_of.size() <= 16);
    const double top_m = 0.06 + 0.02;            // of the rotors' cylinders
    const double half_length_m = 0.32 + 0.1905;  // to their rims
    for (const Goal& place : placed.goal.any_of) {
        REQUIRE(place.touch);
        REQUIRE(std::holds_alternative<ConfigurationGoal>(place.kind));
        CHECK(place.touch->surface_m.z == Approx(5).margin(1e-5));
        CHECK(place.touch->normal.z == -1);
        CHECK(place.touch->hold_s == 4);
        CHECK(place.touch->frame_points_m.size() == 2);
        CHECK(place.touch->frame_points_m.back().x == Approx(half_length_m));
        CHECK(*test::configuration(place).z_m == Approx(5 - 0.3 - top_m).margin(1e-5));
        CHECK(std::abs(*test::configuration(place).x_m) <= 3 - half_length_m - 0.1);
    }
    CHECK(problem_errors(problem).empty());
    CHECK(plannable(problem).problem.goal.any_of.size() == placed.goal.any_of.size());
}

TEST_CASE("the end of the arm touches a wall from a side, and a ceiling from below, along the arm") {
    Problem problem = contact_problem("wall", TouchingPart::end_effector);
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {4.5, 0, 2.5}));
    test::contact(problem.goal).z_m = 2;
    const Problem before_wall = with_touches(problem);
    REQUIRE(before_wall.goal.any_of.size() == 1);  // the far side leaves no room within the bounds
    const Goal& place = before_wall.goal.any_of.front();
    CHECK(place.touch->normal.x == -1);
    CHECK(place.touch->surface_m.x == Approx(4.32).margin(1e-5));
    CHECK(test::end_effector(place).x_m == Approx(4.02).margin(1e-5));
    CHECK(test::end_effector(place).z_m == 2);
    CHECK(*test::end_effector(place).direction_rad == 0);

    test::contact(problem.goal).obstacle = "ceiling";
    test::contact(problem.goal).z_m.reset();
    test::contact(problem.goal).x_m = -1;
    const Problem under_ceiling = with_touches(problem);
    REQUIRE(under_ceiling.goal.any_of.size() == 1);
    CHECK(*test::end_effector(under_ceiling.goal.any_of.front()).direction_rad == Approx(-quarter_turn));
}

TEST_CASE("a contact that a soft law would settle for minutes is an error") {
    using Catch::Matchers::Contains;
    Problem problem = contact_problem("ceiling", TouchingPart::frame);
    test::gains_of(problem.robot).position_kp = 0.05;
    CHECK(problem_errors(problem).empty());
    for (const double kp : {0.04, 0.0}) {
        test::gains_of(problem.robot).position_kp = kp;
        CHECK_THAT(only_error(problem), Contains("robot.controller") && Contains("would settle for more than 60 s"));
    }
}

TEST_CASE("a contact without a place says what is in its way") {
    using Catch::Matchers::Contains;
    Problem problem = contact_problem("celing", TouchingPart::frame);
    CHECK_THAT(only_error(problem),
               Contains("goal.contact.obstacle: is 'celing'") && Contains("did you mean 'ceiling'"));
    problem = contact_problem("ceiling", TouchingPart::frame);
    test::contact(problem.goal).x_m = 40;
    CHECK_THAT(only_error(problem), Contains("goal.contact") && Contains("no way along x or z leads to the obstacle"));
    problem = contact_problem("ceiling", TouchingPart::frame);
    problem.aero.min_distance_radii = 0.3;
    CHECK_THAT(only_error(problem), Contains("come within 0.10") && Contains("aero.min_distance_radii, 0.3"));
    problem = contact_problem("ball", TouchingPart::frame);
    problem.obstacles.push_back({"ball", Sphere{0.5}, {0, 0, 4}, {}});
    CHECK_THAT(only_error(problem), Contains("not flat"));
    problem = contact_problem("ceiling", TouchingPart::frame);
    test::contact(problem.goal).standoff_m = 4.5;
    CHECK_THAT(only_error(problem), Contains("outside the bounds"));
    problem = contact_problem("ceiling", TouchingPart::frame);
    problem.goals_before.push_back(tip_goal(0, 3));
    CHECK_THAT(only_error(problem), Contains("one of several goals"));
    problem.goal = Goal{};
    problem.goals_before.clear();
    CHECK_THAT(only_error(problem), Contains("goal.configuration: is free in every coordinate"));
    problem = contact_problem("ceiling", TouchingPart::frame);
    problem.targets = {std::exchange(problem.goal, {})};
    CHECK_THAT(only_error(problem), Contains("goal.in_any_order[0]") && Contains("expected contact for the only goal"));
}
