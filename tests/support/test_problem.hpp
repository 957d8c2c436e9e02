#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "downwash/problems/problem.hpp"
#include "test_robot.hpp"

namespace downwash::test {

inline Obstacle box(std::string name, const Vector3& size_m, const Vector3& center_m) {
    return {std::move(name), Box{size_m}, center_m, {}};
}

/// A goal for the tip of the arm.
inline Goal tip_goal(double x_m, double z_m) {
    Goal goal;
    goal.kind = EndEffectorGoal{.x_m = x_m, .z_m = z_m, .direction_rad = {}};
    return goal;
}

/// A goal for vehicle and arm; what is not given is free.
inline Goal configuration_goal(std::optional<double> x_m, std::optional<double> z_m,
                               std::optional<double> arm_rad = {}) {
    Goal goal;
    goal.kind = ConfigurationGoal{.x_m = x_m, .z_m = z_m, .arm_rad = arm_rad};
    return goal;
}

/// What a goal of a known kind asks for: auto& as the goal is const or not.
template <class AnyGoal>
auto& end_effector(AnyGoal& goal) {
    return std::get<EndEffectorGoal>(goal.kind);
}
template <class AnyGoal>
auto& configuration(AnyGoal& goal) {
    return std::get<ConfigurationGoal>(goal.kind);
}
template <class AnyGoal>
auto& contact(AnyGoal& goal) {
    return std::get<ContactGoal>(goal.kind);
}

/// A ceiling over the ground and nothing between: the tip of the arm has to get to a point below the ceiling.
inline Problem ceiling_problem() {
    Problem problem;
    problem.name = "ceiling";
    problem.robot = test_robot();
    problem.bounds = {-6, 6, 0.5, 5};
    problem.obstacles = {box("ground", {30, 20, 1}, {0, 0, -0.5}), box("ceiling", {30, 8, 1}, {0, 0, 5.5})};
    problem.start.at[plane::x] = -4;
    problem.start.at[plane::z] = 2;
    problem.start.at[plane::arm] = quarter_turn;
    problem.goal = tip_goal(3, 4.8);
    problem.planner.seed = 1;
    problem.planner.max_iterations = 150;
    return problem;
}

/// The same with the vehicle's place as its goal, the arm at any angle.
inline Problem with_place(double x_m, double z_m) {
    Problem problem = ceiling_problem();
    problem.goal = configuration_goal(x_m, z_m);
    return problem;
}

/// A ceiling, a slab with edges below it, the ground, a pipe: surfaces above and below, whole and partial.
inline Problem cluttered_problem() {
    Problem problem = ceiling_problem();
    problem.obstacles.push_back(box("slab", {2, 3, 0.4}, {0, 0, 3}));
    problem.obstacles.push_back({"pipe", Cylinder{0.25, 6, {0, 1, 0}}, {3, 0, 2.5}, {}});
    return problem;
}

/// How far the tip of the arm of a level vehicle is from the end-effector goal of a problem.
inline double tip_error_m(const Problem& problem, const Configuration& at) {
    const EndEffectorGoal& goal = test::end_effector(problem.goal);
    const double arm_m = problem.robot.arm.length_m;
    return std::hypot(at[plane::x] + arm_m * std::cos(at[plane::arm]) - goal.x_m,
                      at[plane::z] - arm_m * std::sin(at[plane::arm]) - goal.z_m);
}

/// The ceiling problem with a wall across the whole space between start and goal.
inline Problem walled_problem() {
    Problem problem = ceiling_problem();
    problem.name = "walled";
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {0, 0, 2.5}));
    return problem;
}

/// Adds a wall from ground to ceiling with a slit that no vehicle with a margin passes. A disc that the body contains
/// at every pitch would pass it, so that searches are not told beforehand that there is no way.
inline void add_wall_with_slit(Problem& problem, double x_m) {
    problem.obstacles.push_back(box("wall", {0.3, 8, 2.425}, {x_m, 0, 1.2125}));
    problem.obstacles.push_back(box("upper wall", {0.3, 8, 2.425}, {x_m, 0, 3.7875}));
}

/// The ceiling problem with such a wall between start and goal.
inline Problem slit_problem() {
    Problem problem = ceiling_problem();
    problem.name = "slit";
    add_wall_with_slit(problem, 0);
    return problem;
}

/// The ceiling problem with what is not known, and a controller that bears it.
inline Problem uncertain_problem() {
    Problem problem = ceiling_problem();
    ModelInversion& gains = gains_of(problem.robot);
    gains.position_kp = 3;
    gains.position_kd = 3.2;
    gains.position_ki = 1.2;
    gains.attitude_rate_ki = 10;
    gains.arm_ki = 40;
    problem.goal = tip_goal(3, 4.6);
    problem.uncertainty.emplace();
    problem.planner.worlds = 4;
    problem.planner.max_failure_probability = 0.05;
    return problem;
}

}  // namespace downwash::test
