#pragma once

#include <cmath>
#include <numbers>

#include "downwash/controllers/space_gains.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/simulation/space_loop.hpp"

// Robots that tests fly in space, and references for them.

namespace downwash::test {

/// A hexarotor of 2.3 kg with tilted rotors and an arm of 0 to 6 joints below it, about different axes.
inline SpaceRobot space_robot(int joints) {
    SpaceRobot robot;
    robot.name = "space-robot";
    robot.rotor_radius_m = 0.12;
    SpacePlant& plant = robot.plant;
    plant.multirotor = {2.3, {{{0.032, 0.001, 0}, {0.001, 0.035, 0}, {0, 0, 0.055}}}};
    for (int i = 0; i < 6; ++i) {
        const double angle = (30 + 60 * i) * std::numbers::pi / 180;
        const double tilt = 0.08 * (i % 2 == 0 ? 1 : -1);
        plant.rotors.push_back({{0.275 * std::cos(angle), 0.275 * std::sin(angle), 0.05},
                                {-tilt * std::sin(angle), tilt * std::cos(angle), 1},
                                i % 2 == 0 ? 1 : -1,
                                0.015});
        robot.min_thrust_n.push_back(0.2);
        robot.max_thrust_n.push_back(12);
    }
    plant.time_constant_s = 0.03;
    plant.power_coefficient_w_n1p5 = 6;
    plant.drag = {0.3, 0.02};
    const Vector3 axes[] = {{0, 1, 0}, {1, 0, 0}, {0, 1, 0.2}, {1, 0.3, 0}, {0, 1, 0}, {0.1, 0, 1}};
    for (int i = 0; i < joints; ++i) {
        const double size = i < 2 ? 1 : 0.6;
        SpaceLink link;
        link.body = {0.15 * size, {{{3e-4 * size, 0, 0}, {0, 4e-4 * size, 2e-5}, {0, 2e-5, 2e-4 * size}}}};
        link.joint_m = i == 0 ? Vector3{0.02, 0.01, -0.06} : Vector3{0.02, 0, -0.14};
        link.axis = axes[i];
        link.center_of_mass_m = {0.01, 0, -0.07 * size};
        link.drag = {0, 0.01};
        plant.links.push_back(link);
        SpaceLinkLimits limits;
        limits.max_torque_nm = 3;
        robot.links.push_back(limits);
    }
    plant.end_effector_m = {0.03, 0, -0.12};
    robot.controller.rate_hz = 100;
    robot.controller.law = gains_for(plant.time_constant_s, {});
    return robot;
}

/// A reference of four pieces, 12 s in all, through points in motion, with yaw and every joint, to a rest.
inline SpacePlan space_plan(int joints) {
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = joints;
    const double places[5][4] = {
        {0, 0, 2, 0.3}, {0.8, 0.5, 2.4, 0.8}, {1.2, -0.4, 1.9, -0.2}, {0.3, -0.9, 2.2, -1}, {0, 0, 2, 0}};
    const double joint_rad[5] = {0.2, 0.6, -0.3, 0.1, 0.4};
    for (int k = 0; k < 5; ++k) {
        SpaceKnot knot;
        knot.tick = 300 * k;
        for (int axis = 0; axis < 4; ++axis) {
            knot.point.position[axis] = places[k][axis];
        }
        for (int i = 0; i < joints; ++i) {
            knot.point.position[space::first_joint + i] = joint_rad[k] * (i % 2 == 0 ? 1 : -0.7);
        }
        if (k == 1 || k == 2) {
            knot.point.velocity[space::x] = k == 1 ? 0.3 : -0.1;
            knot.point.velocity[space::y] = k == 1 ? -0.2 : -0.3;
        }
        plan.reference.push_back(knot);
    }
    return plan;
}

/// The motion of a vehicle that rests level at a reference point.
inline SpaceMotion motion_at_rest(const SpacePoint& point) {
    SpaceMotion motion;
    motion.position_m = {point.position[0], point.position[1], point.position[2]};
    const double half = 0.5 * point.position[space::yaw];
    motion.attitude = {std::cos(half), 0, 0, std::sin(half)};
    for (std::size_t i = 0; i < max_joints; ++i) {
        motion.joints_rad[i] = point.position[space::first_joint + static_cast<int>(i)];
    }
    return motion;
}

}  // namespace downwash::test
