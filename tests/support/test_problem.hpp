#pragma once

#include <string>
#include <utility>

#include "downwash/problems/problem.hpp"
#include "test_robot.hpp"

namespace downwash::test {

inline Obstacle box(std::string name, const Vector3& size_m, const Vector3& center_m) {
    Obstacle obstacle;
    obstacle.name = std::move(name);
    obstacle.shape = Box{size_m};
    obstacle.center_world_m = center_m;
    return obstacle;
}

/// A ceiling over the ground and nothing between: the tip of the arm has to get to a point below the ceiling.
inline Problem ceiling_problem() {
    Problem problem;
    problem.name = "ceiling";
    problem.robot = test_robot();
    problem.bounds = {-6, 6, 0.5, 5};
    problem.obstacles = {box("ground", {30, 20, 1}, {0, 0, -0.5}), box("ceiling", {30, 8, 1}, {0, 0, 5.5})};
    problem.start.x_m = -4;
    problem.start.z_m = 2;
    problem.start.arm_rad = 1.5707963267948966;
    EndEffectorGoal goal;
    goal.x_m = 3;
    goal.z_m = 4.8;
    problem.goal.end_effector = goal;
    problem.goal.hold_s = 5;
    problem.planner.seed = 1;
    problem.planner.max_iterations = 150;
    return problem;
}

/// The same with the vehicle's place as its goal, the arm at any angle.
inline Problem with_place(double x_m, double z_m) {
    Problem problem = ceiling_problem();
    problem.goal.end_effector.reset();
    problem.goal.configuration = ConfigurationGoal{};
    problem.goal.configuration->x_m = x_m;
    problem.goal.configuration->z_m = z_m;
    return problem;
}

/// The ceiling problem with a wall across the whole space between start and goal.
inline Problem walled_problem() {
    Problem problem = ceiling_problem();
    problem.name = "walled";
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {0, 0, 2.5}));
    return problem;
}

}  // namespace downwash::test
