#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "../support/test_problem.hpp"
#include "downwash/base/angles.hpp"
#include "downwash/problems/goal_reach.hpp"

using namespace downwash;

namespace {

Problem with_configuration_goal() {
    Problem problem = test::ceiling_problem();
    problem.goal.end_effector.reset();
    problem.goal.configuration = ConfigurationGoal{};
    return problem;
}

}  // namespace

TEST_CASE("a pose between the angles of a coarse grid is found") {
    Problem problem = test::ceiling_problem();
    ArmParameters& arm = problem.robot.arm;
    arm.is_limited = true;
    arm.lower_limit_rad = 10.1 / degrees_per_radian;
    arm.upper_limit_rad = 10.4 / degrees_per_radian;
    problem.goal.end_effector->z_m = 3;
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    problem.goal.end_effector->direction_rad = 10.7 / degrees_per_radian;
    problem.goal.end_effector->direction_tolerance_rad = 0.4 / degrees_per_radian;  // nine tenths of it reach 10.34
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    problem.goal.end_effector->direction_rad = 10.8 / degrees_per_radian;
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::none);
}

TEST_CASE("of a wide tolerance of the arm the one angle that is clear is found") {
    // Beams along y leave the arm of 1.2 m one direction, forward and down by 45 degrees.
    Problem problem = with_configuration_goal();
    ConfigurationGoal& goal = *problem.goal.configuration;
    goal.x_m = 0;
    goal.z_m = 2.5;
    goal.arm_rad = 0;
    goal.tolerance_rad = 180 / degrees_per_radian;
    goal.tolerance_m = 0.01;
    for (int angle_deg = -180; angle_deg < 180; angle_deg += 15) {
        if (angle_deg != 45) {
            const double angle_rad = angle_deg / degrees_per_radian;
            problem.obstacles.push_back(test::box("beam " + std::to_string(angle_deg), {0.15, 8, 0.15},
                                                  {std::cos(angle_rad), 0, 2.5 - std::sin(angle_rad)}));
        }
    }
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::clear);
    problem.obstacles.push_back(test::box("beam 45", {0.15, 8, 0.15}, {std::sqrt(0.5), 0, 2.5 - std::sqrt(0.5)}));
    CHECK(reach_of(ProblemCheck(problem), problem.goal) == Reach::blocked);
}

TEST_CASE("a gap anywhere in a wide disc is found, and a very wide one is left to the search") {
    // Two blocks with a gap for the vehicle between them, 1.05 m beside the middle of the goal.
    Problem problem = with_configuration_goal();
    ConfigurationGoal& goal = *problem.goal.configuration;
    goal.x_m = 0;
    goal.z_m = 2.5;
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
