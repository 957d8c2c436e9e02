// Plans in space from C++: a hexarotor whose two-joint arm reaches a place beside a girder, in a direction.

#include <cmath>
#include <cstdio>
#include <memory>

#include <downwash/planner/space_solve.hpp>
#include <downwash/simulation/space_design.hpp>

using namespace downwash;

namespace {

SpaceLink link(const Vector3& joint_m, double mass_kg, const Vector3& center_of_mass_m) {
    SpaceLink made;
    made.joint_m = joint_m;
    made.axis = {0, 1, 0};
    made.center_of_mass_m = center_of_mass_m;
    made.body = {mass_kg, {{{2e-5, 0, 0}, {0, 3e-4, 0}, {0, 0, 3e-4}}}};
    return made;
}

/// Six rotors on a circle, every other one turning the other way, and an arm that hangs below.
SpaceRobot hexarotor() {
    SpaceRobot robot;
    robot.name = "hexarotor-with-arm";
    robot.plant.multirotor = {2.1, {{{0.018, 0, 0}, {0, 0.018, 0}, {0, 0, 0.03}}}};
    robot.plant.time_constant_s = 0.02;
    robot.plant.power_coefficient_w_n1p5 = 5;
    for (int i = 0; i < 6; ++i) {
        const double angle_rad = 0.5235987755982988 * (1 + 2 * i);
        robot.plant.rotors.push_back(
            {{0.19 * std::cos(angle_rad), 0.19 * std::sin(angle_rad), 0.05}, {0, 0, 1}, i % 2 == 0 ? 1 : -1, 0.017});
        robot.min_thrust_n.push_back(0);
        robot.max_thrust_n.push_back(12);
    }
    robot.rotor_radius_m = 0.09;
    robot.body = {{Box{{0.4, 0.4, 0.12}}, {0, 0, 0}}};
    robot.plant.links = {link({0, 0, -0.1}, 0.12, {0, 0, -0.08}), link({0, 0, -0.16}, 0.08, {0, 0, -0.07})};
    robot.plant.end_effector_m = {0, 0, -0.15};
    robot.tool_direction = {0, 0, -1};
    for (const double length_m : {0.16, 0.15}) {
        SpaceLinkLimits limits;
        limits.is_limited = true;
        limits.lower_limit_rad = -1.6;
        limits.upper_limit_rad = 1.6;
        limits.max_torque_nm = 2;
        limits.body = {{Capsule{0.015, {0, 0, 0}, {0, 0, -length_m}}, {0, 0, 0}}};
        robot.links.push_back(limits);
    }
    robot.controller.law = designed_inversion(robot);  // gains as fast as the rotors allow
    return robot;
}

SpaceProblem problem_beside_a_girder() {
    SpaceProblem problem;
    problem.robot = hexarotor();
    problem.bounds = {{-4, -3, 0.5}, {4, 3, 5}};
    problem.obstacles = {{"ground", Box{{30, 20, 1}}, {0, 0, -0.5}}, {"girder", Box{{8, 0.3, 1.2}}, {0, 1.5, 3.6}}};
    problem.start.position_m = {-3, -2, 1.5};
    SpaceEndEffectorGoal goal;
    goal.position_m = {1, 1.1, 3.4};  // 25 cm from its web
    goal.direction = Vector3{0, 1, -1};
    goal.direction_tolerance_rad = 0.35;
    problem.goals = {SpaceGoal{goal}};
    problem.planner.max_iterations = 60;
    return problem;
}

}  // namespace

int main() {
    const SpaceProblem problem = problem_beside_a_girder();
    for (const auto& errors : {space_problem_errors(problem), space_planning_errors(problem)}) {
        for (const KeyError& error : errors) {
            std::printf("%s %s\n", error.key.c_str(), error.message.c_str());
        }
        if (!errors.empty()) {
            return 2;
        }
    }
    const SpaceSearchResult found = solve(std::make_shared<const SpaceProblemModel>(problem));
    if (found.status != Status::solved || !found.execution) {
        return 1;
    }
    const SpaceFlight& flight = *found.execution;
    const Vector3& end_m = flight.rows.back().end_effector_m;
    std::printf("%zu knots, %.1f s, %.0f J, end effector at (%.2f, %.2f, %.2f) m: %s\n", found.plan->reference.size(),
                flight.duration_s, flight.energy_j, end_m[0], end_m[1], end_m[2],
                flight.outcome == Outcome::ok ? "held at the goal" : "failed");
    return flight.outcome == Outcome::ok ? 0 : 3;
}
