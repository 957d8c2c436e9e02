#pragma once

#include <algorithm>
#include <cmath>

#include "../support/test_robot.hpp"
#include "downwash/controllers/space_gains.hpp"
#include "downwash/controllers/space_law_model.hpp"
#include "downwash/dynamics/space_step.hpp"

// A planar robot and the same in space.

namespace downwash::test {

/// Numbers of problems/robots/ars_lrm.yaml, but for the drag of the air.
inline Robot shipped_robot() {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.05;
    robot.rotors.power_coefficient_w_n1p5 = 3.154;
    ModelInversion& gains = gains_of(robot);
    gains.position_kp = 2;
    gains.position_kd = 2.4;
    gains.position_ki = 0.8;
    gains.height_kp = 12;
    gains.height_kd = 7;
    gains.height_ki = 6;
    gains.attitude_kp = 2;
    gains.attitude_rate_kp = 14;
    gains.attitude_rate_ki = 8;
    gains.pitch_rate_filter_s = 0.25;
    gains.arm_kp = 22;
    gains.arm_kd = 9.5;
    gains.arm_ki = 5;
    gains.rotor_lead = 1;
    gains.aids.observer = controllers::DisturbanceObserver{3};
    return robot;
}

/// The same robot in space. What the plane does not know is arbitrary: inertias about other axes, drag torques.
inline SpacePlant in_space(const Robot& robot) {
    SpacePlant plant;
    plant.multirotor = {robot.multirotor.mass_kg,
                        {{{0.21, 0, 0}, {0, robot.multirotor.pitch_inertia_kg_m2, 0}, {0, 0, 0.38}}}};
    plant.links.push_back({{robot.arm.mass_kg, {{{0.001, 0, 0}, {0, robot.arm.inertia_kg_m2, 0}, {0, 0, 0.06}}}},
                           {robot.arm.joint_x_m, 0, robot.arm.joint_z_m},
                           {0, 1, 0},
                           {robot.arm.center_of_mass_m, 0, 0}});
    for (const Vector3& hub : robot.rotors.positions_m) {
        plant.rotors.push_back({hub, {0, 0, 1}, hub[0] * hub[1] > 0 ? 1 : -1, 0.02});
    }
    plant.time_constant_s = robot.rotors.time_constant_s;
    plant.power_coefficient_w_n1p5 = robot.rotors.power_coefficient_w_n1p5;
    return plant;
}

/// What its law knows.
inline SpaceLawModel<1> law_model_of(const Robot& robot) {
    const std::size_t rotors = robot.rotors.positions_m.size();
    return make_space_law_model<1>(in_space(robot), std::vector<double>(rotors, robot.rotors.min_thrust_n),
                                   std::vector<double>(rotors, robot.rotors.max_thrust_n), {robot.arm.max_torque_nm});
}

/// The state of the plane in space.
inline dynamics::SpaceState<double, 1> lifted(const dynamics::PlantState<double>& planar) {
    dynamics::SpaceState<double, 1> space{
        {planar.q[0], 0, planar.q[1], std::cos(planar.q[2] / 2), 0, std::sin(planar.q[2] / 2), 0, planar.q[3]},
        {planar.u[0], 0, planar.u[1], 0, planar.u[2], 0, planar.u[3]},
        {},
        planar.energy_j};
    std::copy(planar.thrust_n, planar.thrust_n + max_rotors, space.thrust_n);
    return space;
}

/// The reference of the plane in space.
inline BasicSpacePoint<double, 1> lifted(const ReferencePoint& planar) {
    BasicSpacePoint<double, 1> point;
    const int axis[] = {space::x, space::z, space::first_joint};
    for (int i = 0; i < 3; ++i) {
        point.position[axis[i]] = planar.position[i];
        point.velocity[axis[i]] = planar.velocity[i];
        point.acceleration[axis[i]] = planar.acceleration[i];
    }
    return point;
}

}  // namespace downwash::test
