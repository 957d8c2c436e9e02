#include "downwash/report/shown_robot.hpp"

#include <algorithm>
#include <memory>
#include <numbers>
#include <variant>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/robot_facts.hpp"
#include "downwash/simulation/space_robot_facts.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash {
namespace {

std::vector<double> pose_near_zero(const SpaceRobot& robot) {
    std::vector<double> joints_rad;
    for (const SpaceLinkLimits& link : robot.links) {
        joints_rad.push_back(link.is_limited ? std::clamp(0.0, link.lower_limit_rad, link.upper_limit_rad) : 0.0);
    }
    return joints_rad;
}

std::vector<double> scaled_difference(double scale, const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> difference;
    for (std::size_t k = 0; k < a.size(); ++k) {
        difference.push_back(scale * (a[k] - b[k]));
    }
    return difference;
}

/// A planar robot in space. Its inertia about other axes than y is not known, and 0.
SpaceRobot in_space(const Robot& planar) {
    SpaceRobot robot;
    robot.name = planar.name;
    robot.plant.multirotor.mass_kg = planar.multirotor.mass_kg;
    robot.plant.multirotor.inertia_kg_m2[1][1] = planar.multirotor.pitch_inertia_kg_m2;
    for (const BodyShape& body : planar.body) {
        robot.body.push_back(
            {std::visit([](const auto& shape) { return SpaceShape(shape); }, body.shape), body.center_body_m});
    }
    for (const Vector3& position_m : planar.rotors.positions_m) {
        robot.plant.rotors.push_back({position_m, {0, 0, 1}, 0, 0});
        robot.min_thrust_n.push_back(planar.rotors.min_thrust_n);
        robot.max_thrust_n.push_back(planar.rotors.max_thrust_n);
    }
    robot.rotor_radius_m = planar.rotors.radius_m;
    const ArmParameters& arm = planar.arm;
    SpaceLink link;
    link.body.mass_kg = arm.mass_kg;
    link.body.inertia_kg_m2[1][1] = arm.inertia_kg_m2;
    link.joint_m = {arm.joint_x_m, 0, arm.joint_z_m};
    link.center_of_mass_m = {arm.center_of_mass_m, 0, 0};
    robot.plant.links.push_back(link);
    SpaceLinkLimits limits;
    limits.is_limited = arm.is_limited;
    limits.lower_limit_rad = arm.lower_limit_rad;
    limits.upper_limit_rad = arm.upper_limit_rad;
    limits.max_torque_nm = arm.max_torque_nm;
    limits.body = {{Capsule{arm.radius_m, {0, 0, 0}, {arm.length_m, 0, 0}}, {}}};
    robot.links.push_back(limits);
    robot.plant.end_effector_m = {arm.length_m, 0, 0};
    return robot;
}

/// The commands with which a planar robot hovers, at two angles of the arm: they are linear in where the weight is.
HoverThrusts hover_of(const Robot& planar, const SpaceRobot& robot) {
    AeroSettings calm;
    calm.enabled = false;
    const FlightModel model(planar, {}, std::make_shared<const Scene>(std::vector<Obstacle>{}), calm);
    const auto commands_n = [&](double arm_rad) {
        const HoverTrim trim = analyse_hover(model, 0, 0, arm_rad).trim;
        return std::vector<double>(trim.rotor_command_n, trim.rotor_command_n + robot.plant.rotors.size());
    };
    const auto forward_m = [&](double arm_rad) { return center_of_mass_m(robot, arm_pose(robot, {arm_rad}))[0]; };
    constexpr double half_turn_rad = std::numbers::pi;
    const std::vector<double> ahead_n = commands_n(0), behind_n = commands_n(half_turn_rad);
    const double apart_m = forward_m(0) - forward_m(half_turn_rad);
    HoverThrusts hover;
    hover.left_n_m.assign(ahead_n.size(), 0);
    hover.forward_n_m = apart_m > 0 ? scaled_difference(1 / apart_m, ahead_n, behind_n) : hover.left_n_m;
    for (std::size_t k = 0; k < ahead_n.size(); ++k) {
        hover.middle_n.push_back(ahead_n[k] - forward_m(0) * hover.forward_n_m[k]);
    }
    return hover;
}

}  // namespace

std::vector<double> HoverThrusts::at(const Vector3& at_m) const {
    std::vector<double> thrusts_n;
    for (std::size_t k = 0; k < middle_n.size(); ++k) {
        thrusts_n.push_back(middle_n[k] + at_m[0] * forward_n_m[k] + at_m[1] * left_n_m[k]);
    }
    return thrusts_n;
}

ShownRobot shown_robot(const SpaceRobot& robot) {
    const SpaceRobotFacts facts = space_robot_facts(robot);
    ShownRobot shown;
    shown.robot = robot;
    shown.thrust_to_weight = facts.thrust_to_weight;
    shown.reach_m = facts.reach_m;
    shown.hover_share = facts.hover_share;
    shown.hover_rotor = facts.hover_rotor;
    shown.hover_joints_rad = facts.hover_joints_rad;
    const double weight_n = facts.mass_kg * standard_gravity_m_s2;
    const std::vector<double> middle = thrust_shares(robot.plant, {});
    const std::vector<double> none(middle.size(), 0);
    shown.hover.middle_n = scaled_difference(weight_n, middle, none);
    shown.hover.forward_n_m = scaled_difference(weight_n, thrust_shares(robot.plant, {1, 0, 0}), middle);
    shown.hover.left_n_m = scaled_difference(weight_n, thrust_shares(robot.plant, {0, 1, 0}), middle);
    shown.joints_rad = pose_near_zero(robot);
    return shown;
}

ShownRobot shown_robot(const Robot& robot) {
    const RobotFacts facts = robot_facts(robot);
    ShownRobot shown;
    shown.robot = in_space(robot);
    shown.is_planar = true;
    shown.thrust_to_weight = facts.thrust_to_weight;
    shown.reach_m = facts.reach_m;
    shown.hover_share = facts.hover_share;
    shown.hover_rotor = facts.hover_rotor;
    shown.hover_joints_rad = {facts.hover_arm_rad};
    shown.hover = hover_of(robot, shown.robot);
    shown.joints_rad = pose_near_zero(shown.robot);
    return shown;
}

std::vector<double> hover_shares(const ShownRobot& shown) {
    const SpaceRobot& robot = shown.robot;
    std::vector<double> shares = shown.hover.at(center_of_mass_m(robot, arm_pose(robot, shown.joints_rad)));
    for (std::size_t k = 0; k < shares.size(); ++k) {
        shares[k] /= robot.max_thrust_n[k];
    }
    return shares;
}

}  // namespace downwash
