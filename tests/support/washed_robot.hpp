#pragma once

#include "test_robot.hpp"

namespace downwash::test {

/// The test robot in plus layout, so that its arm sweeps below its front and its rear rotor, and with a wash.
inline Robot washed_robot() {
    Robot robot = test_robot();
    robot.rotors.positions_m = {{0.45, 0, 0.06}, {-0.45, 0, 0.06}, {0, 0.45, 0.06}, {0, -0.45, 0.06}};
    robot.body.resize(1);
    for (const Vector3& hub_m : robot.rotors.positions_m) {
        robot.body.push_back({Cylinder{robot.rotors.radius_m, 0.04, {0, 0, 1}}, hub_m});
    }
    robot.multirotor.drag = {1.0, 0.047};
    robot.arm.drag = {0, 0.0485};
    robot.arm.wash.emplace();
    return robot;
}

}  // namespace downwash::test
