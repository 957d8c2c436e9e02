#pragma once

#include "../controllers/planar_twin.hpp"
#include "downwash/simulation/space_robot.hpp"

// The shipped planar robot as one in space.

namespace downwash::test {

/// The shipped robot with its drag and the age of what its controller sees.
inline Robot shipped_robot_in_air() {
    Robot robot = shipped_robot();
    robot.multirotor.drag = {1.0, 0.047};
    robot.arm.drag = {0, 0.0485};
    robot.controller.delay_s = 0.01;
    return robot;
}

/// The same in space.
inline SpaceRobot twin_of(const Robot& robot) {
    SpaceRobot twin;
    twin.name = robot.name;
    twin.plant = in_space(robot);
    twin.plant.drag = robot.multirotor.drag;
    twin.plant.links[0].drag = robot.arm.drag;
    twin.plant.end_effector_m = {robot.arm.length_m, 0, 0};
    twin.plant.wash = robot.arm.wash;
    const std::size_t rotors = robot.rotors.positions_m.size();
    twin.rotor_radius_m = robot.rotors.radius_m;
    twin.min_thrust_n.assign(rotors, robot.rotors.min_thrust_n);
    twin.max_thrust_n.assign(rotors, robot.rotors.max_thrust_n);
    SpaceLinkLimits limits;
    limits.max_torque_nm = robot.arm.max_torque_nm;
    twin.links.push_back(limits);
    twin.controller.rate_hz = robot.controller.rate_hz;
    twin.controller.delay_s = robot.controller.delay_s;
    twin.controller.law = from_planar(gains_of(robot));
    return twin;
}

}  // namespace downwash::test
