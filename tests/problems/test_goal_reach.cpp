#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "../support/test_problem.hpp"
#include "downwash/base/angles.hpp"
#include "downwash/problems/goal_reach.hpp"

using namespace downwash;

TEST_CASE("a pose between the angles of a coarse grid is found") {
    Problem problem = test::ceiling_problem();
    test::limit_arm(problem.robot, 10.1 / degrees_per_radian, 10.4 / degrees_per_radian);
    test::end_effector(problem.goal).z_m = 3;
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    test::end_effector(problem.goal).direction_rad = 10.7 / degrees_per_radian;
    test::end_effector(problem.goal).direction_tolerance_rad =
        0.4 / degrees_per_radian;  // nine tenths of it reach 10.34
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    test::end_effector(problem.goal).direction_rad = 10.8 / degrees_per_radian;
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::none);
}

TEST_CASE("of a wide tolerance of the arm the one angle that is clear is found") {
    // Beams along y leave the arm of 1.2 m one direction, forward and down by 45 degrees.
    Problem problem = test::with_place(0, 2.5);
    ConfigurationGoal& goal = test::configuration(problem.goal);
    goal.arm_rad = 0;
    goal.tolerance_rad = 180 / degrees_per_radian;
    goal.tolerance_m = 0.01;
    const auto add_beam = [&problem](int angle_deg) {
        const double angle_rad = angle_deg / degrees_per_radian;
        problem.obstacles.push_back(test::box("beam " + std::to_string(angle_deg), {0.15, 8, 0.15},
                                              {std::cos(angle_rad), 0, 2.5 - std::sin(angle_rad)}));
    };
    for (int angle_deg = 60; angle_deg < 45 + 360; angle_deg += 15) {
        add_beam(angle_deg);
    }
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    add_beam(45);
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::blocked);
}

TEST_CASE("a gap anywhere in a wide disc is found, and a very wide one is left to the search") {
    // Two blocks with a gap for the vehicle between them, 1.05 m beside the middle of the goal.
    Problem problem = test::with_place(0, 2.5);
    ConfigurationGoal& goal = test::configuration(problem.goal);
    goal.arm_rad = 90 / degrees_per_radian;
    goal.tolerance_m = 1.5;
    problem.obstacles.push_back(test::box("left", {6, 8, 5}, {0.4 - 3, 0, 2.5}));
    problem.obstacles.push_back(test::box("right", {6, 8, 5}, {1.7 + 3, 0, 2.5}));
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    problem.obstacles.push_back(test::box("between", {2, 8, 5}, {1, 0, 2.5}));
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::blocked);
    goal.tolerance_m = 3;
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
}
