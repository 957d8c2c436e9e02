#pragma once

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/robot.hpp"
#include "surroundings.hpp"

namespace downwash::test {

inline constexpr double quarter_turn = 1.57079632679489661923;

/// The aerial manipulator that the tests fly: a quadrotor of 4.5 kg in X layout and an arm of 1.2 m that turns about
/// its centre of mass. Rotors without lag, joint without limits.
inline Robot test_robot() {
    Robot robot;
    robot.name = "test-robot";
    robot.multirotor = {4.5, 0.20};

    constexpr double rotor_radius_m = 0.1905;
    constexpr double reach_m = 0.32;
    constexpr double height_m = 0.06;
    robot.body.push_back({Box{{0.40, 0.40, 0.12}}, {0, 0, 0}});
    robot.rotors.radius_m = rotor_radius_m;
    for (const double x_m : {reach_m, -reach_m}) {
        for (const double y_m : {reach_m, -reach_m}) {
            robot.rotors.positions_m.push_back({x_m, y_m, height_m});
            robot.body.push_back({Cylinder{rotor_radius_m, 0.04, {0, 0, 1}}, {x_m, y_m, height_m}});
        }
    }
    robot.rotors.min_thrust_n = 0;
    robot.rotors.max_thrust_n = 28;
    robot.rotors.time_constant_s = 0;
    robot.rotors.power_coefficient_w_n1p5 = 2.9;

    robot.arm.length_m = 1.2;
    robot.arm.mass_kg = 0.45;
    robot.arm.center_of_mass_m = 0.72;
    robot.arm.inertia_kg_m2 = 0.06;
    robot.arm.radius_m = 0.03;
    robot.arm.max_torque_nm = 12;

    robot.controller.rate_hz = 100;
    ModelInversion gains;
    gains.position_kp = 2.0;
    gains.position_kd = 2.6;
    gains.position_ki = 0.4;
    gains.attitude_kp = 8;
    gains.attitude_rate_kp = 20;
    gains.arm_kp = 30;
    gains.arm_kd = 11;
    robot.controller.law = gains;
    return robot;
}

/// The gains of a robot that model inversion flies.
inline ModelInversion& gains_of(Robot& robot) {
    return std::get<ModelInversion>(robot.controller.law);
}
inline const ModelInversion& gains_of(const Robot& robot) {
    return std::get<ModelInversion>(robot.controller.law);
}

/// Gives a law an observer, a feed-forward, or both, if it is one that can have them.
inline void give_aids(ControlLaw& law, const controllers::Aids& aids) {
    std::visit(
        [&]<class Law>(Law& own) {
            if constexpr (controllers::CanBeAided<Law>) {
                own.aids = aids;
            }
        },
        law);
}

inline void limit_arm(Robot& robot, double lower_rad, double upper_rad) {
    robot.arm.is_limited = true;
    robot.arm.lower_limit_rad = lower_rad;
    robot.arm.upper_limit_rad = upper_rad;
}

/// Its plant.
inline PlantModel plant_of(const Robot& robot) {
    return make_plant_model(robot.multirotor, robot.arm, robot.rotors);
}

}  // namespace downwash::test
