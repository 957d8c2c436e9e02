#include <catch2/catch.hpp>
#include <span>
#include <string>
#include <utility>

#include "../support/error_of.hpp"
#include "../support/test_problem.hpp"
#include "downwash/problems/placed_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
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
    REQUIRE(placed.goal.places.size() > 5);
    REQUIRE(placed.goal.places.size() <= 16);
    const double top_m = 0.06 + 0.02;            // of the rotors' cylinders
    const double half_length_m = 0.32 + 0.1905;  // to their rims
    for (const Goal& place : placed.goal.places) {
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
    CHECK(plannable(problem).problem.goal.places.size() == placed.goal.places.size());
}

TEST_CASE("the end of the arm touches a wall from a side, and a ceiling from below, along the arm") {
    Problem problem = contact_problem("wall", TouchingPart::end_effector);
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {4.5, 0, 2.5}));
    test::contact(problem.goal).z_m = 2;
    const Problem before_wall = with_touches(problem);
    REQUIRE(before_wall.goal.places.size() == 1);  // the far side leaves no room within the bounds
    const Goal& place = before_wall.goal.places.front();
    CHECK(place.touch->normal.x == -1);
    CHECK(place.touch->surface_m.x == Approx(4.32).margin(1e-5));
    CHECK(test::end_effector(place).x_m == Approx(4.02).margin(1e-5));
    CHECK(test::end_effector(place).z_m == 2);
    CHECK(*test::end_effector(place).direction_rad == 0);

    test::contact(problem.goal).obstacle = "ceiling";
    test::contact(problem.goal).z_m.reset();
    test::contact(problem.goal).x_m = -1;
    const Problem under_ceiling = with_touches(problem);
    REQUIRE(under_ceiling.goal.places.size() == 1);
    CHECK(*test::end_effector(under_ceiling.goal.places.front()).direction_rad == Approx(-quarter_turn));
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
    problem.goal = Goal{};
    CHECK_THAT(only_error(problem), Contains("goal.configuration: is free in every coordinate"));
}

TEST_CASE("contacts in lists, among alternatives and in any order have places of their own") {
    const Problem alone = contact_problem("ceiling", TouchingPart::frame);
    Goal here = alone.goal, there = alone.goal;
    contact(here).x_m = -2;
    contact(there).x_m = 2;
    there.hold_s = 7;
    Goal either;
    either.any_of = {tip_goal(0, 3), here, there};

    Problem problem = alone;
    problem.goals_before = {here, tip_goal(0, 3)};
    problem.goal = there;
    Problem placed = with_touches(problem);
    REQUIRE(placed.goals_before[0].places.size() == 1);
    CHECK(*configuration(placed.goals_before[0].places[0]).x_m == -2);
    CHECK(placed.goals_before[0].places[0].touch->hold_s == 4);
    CHECK(placed.goals_before[1].places.empty());
    REQUIRE(placed.goal.places.size() == 1);
    CHECK(placed.goal.places[0].touch->hold_s == 7);
    CHECK(problem_errors(problem).empty());

    const auto check_choice = [&](const Goal& choice) {
        const std::span<const Goal> all = alternatives(choice);
        REQUIRE(all.size() == 3);
        CHECK_FALSE(all[0].touch);
        CHECK(end_effector(all[0]).x_m == 0);
        CHECK(*configuration(all[1]).x_m == -2);
        CHECK(*configuration(all[2]).x_m == 2);
        CHECK(all[2].touch->hold_s == 7);
        CHECK(choice.any_of[1].places.size() == 1);  // it may become a goal of its own
        CHECK(may_touch(choice));
        CHECK_FALSE(asks_for_contact(choice));
    };
    problem = alone;
    problem.goal = either;
    CHECK(problem_errors(problem).empty());
    check_choice(with_touches(problem).goal);
    problem.goal = {};
    problem.targets = {here, either, tip_goal(0, 3)};
    CHECK(problem_errors(problem).empty());
    placed = with_touches(problem);
    CHECK(placed.targets[0].places.size() == 1);
    check_choice(placed.targets[1]);
    CHECK(placed.targets[2].places.empty());
    // Found anew, not added.
    CHECK(with_touches(placed).targets[1].places.size() == 3);
}

TEST_CASE("what is wrong with a contact among several goals is said of that one") {
    using Catch::Matchers::Contains;
    const Problem alone = contact_problem("ceiling", TouchingPart::frame);
    Goal astray = alone.goal, elsewhere = alone.goal;
    contact(astray).obstacle = "celing";
    contact(elsewhere).x_m = 40;
    Problem problem = alone;
    problem.goals_before = {tip_goal(0, 3), astray};
    CHECK_THAT(only_error(problem), Contains("goal[1].contact.obstacle: is 'celing'"));
    problem.goals_before[1] = elsewhere;
    CHECK_THAT(only_error(problem), Contains("goal[1].contact: ") && Contains("no way along x or z leads"));
    problem = alone;
    problem.goal = {};
    problem.goal.any_of = {alone.goal, elsewhere};
    CHECK_THAT(only_error(problem), Contains("goal.any_of[1].contact: ") && Contains("no way along x or z leads"));
    problem.targets = {std::exchange(problem.goal, {}), tip_goal(0, 3)};
    CHECK_THAT(only_error(problem), Contains("goal.in_any_order[0].any_of[1].contact: "));
}

TEST_CASE("a contact among several goals is written as it was read") {
    const Problem problem = read_problem(DOWNWASH_PROBLEMS "/contact/deck_and_pier.yaml");
    REQUIRE(problem.goals_before.size() == 3);
    CHECK(contact(problem.goals_before[1]).obstacle == "deck");
    CHECK(contact(problem.goals_before[1]).x_m == -1);
    CHECK(contact(problem.goal).part == TouchingPart::end_effector);
    for (const bool is_choice : {false, true}) {
        Problem written = problem;
        if (is_choice) {
            Goal either;
            either.any_of = {problem.goals_before[1], problem.goals_before[2]};
            written.targets = {either, problem.goal};
            written.goals_before.clear();
            written.goal = {};
        }
        const std::string text = effective_yaml(written, ".");
        const Problem again = parse_values(text, "again");
        CHECK(effective_yaml(again, ".") == text);
        const Goal& deck = is_choice ? again.targets.at(0).any_of.at(0) : again.goals_before.at(1);
        CHECK(contact(deck).force_n == 5);
        CHECK(deck.hold_s == 5);
        CHECK(contact(is_choice ? again.targets.at(1) : again.goal).z_m == 6);
    }
}
