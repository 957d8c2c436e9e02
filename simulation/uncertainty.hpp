#pragma once

#include "downwash/base/spread.hpp"

namespace downwash {

/// How well the numbers of vehicle, sensors, surfaces and air are known. A robot file may state those of vehicle and
/// sensors. docs/model.md 9 says where the defaults come from; simulation/world_parameters.hpp has the keys.
struct Uncertainty {
    // Relative to K - 1: the scatter of all measurements about the default models (docs/aeromap.md). For the ground, a
    // normal distribution would turn lift into suction; a uniform one of that standard deviation does not.
    Spread ceiling_scale = Spread::of_sd(0.15);
    Spread ground_scale = Spread::over(-0.8, 0.8);
    Spread scene_x_m = Spread::of_sd(0.02);
    Spread scene_y_m = Spread::of_sd(0.02);
    Spread scene_z_m = Spread::of_sd(0.02);
    Spread scene_yaw_rad = Spread::of_sd(0.003490658503988659);  ///< In space; 2 cm at 6 m from the origin.

    Spread mass_scale = Spread::of_sd(0.02);
    Spread inertia_scale = Spread::of_sd(0.05);
    Spread arm_mass_scale = Spread::of_sd(0.05);
    Spread center_of_mass_x_m = Spread::of_sd(0.005);
    Spread center_of_mass_y_m = Spread::of_sd(0.005);  ///< In space.
    Spread center_of_mass_z_m = Spread::of_sd(0.005);
    Spread thrust_scale = Spread::of_sd(0.03);
    Spread rotor_thrust_scale = Spread::of_sd(0.01);                ///< Each rotor draws a number of its own.
    Spread arm_wash_scale = Spread::of_sd(0.15);                    ///< Of a robot whose arm is in the wash.
    Spread rotor_time_constant_s = Spread::of_factor(0.7, 1.5);     ///< A range is one of the time constant itself.
    Spread delay_s = Spread::of_factor(0.5, 1.5);                   ///< A range is one of the delay itself.
    Spread lateral_error_m = Spread::of_sd(0.01);                   ///< Beside the gusts; in the plane.
    Spread joint_offset_rad = Spread::of_sd(0.005235987755982988);  ///< In space; each joint draws a number of its own.

    Spread position_bias_m = Spread::of_sd(0.01);                 ///< x, y and z draw a number each.
    Spread pitch_bias_rad = Spread::of_sd(0.005235987755982988);  ///< In space roll and pitch draw a number each.
    Spread yaw_bias_rad = Spread::of_sd(0.008726646259971648);    ///< In space.
    Spread position_noise_m = Spread::of_sd(0.005);               ///< Only the sd of a noise has a meaning.
    Spread velocity_noise_m_s = Spread::of_sd(0.02);
    Spread gyro_noise_rad_s = Spread::of_sd(0.015);

    Spread wind_x_m_s = Spread::of_sd(0.5);
    Spread wind_y_m_s = Spread::of_sd(0.5);
    Spread wind_z_m_s = Spread::of_sd(0.1);
    Spread gust_m_s = Spread::of_sd(0.3);
    double gust_length_x_m = 23;  ///< Length scales of the Dryden model 3 m above the ground.
    double gust_length_z_m = 3;

    friend constexpr bool operator==(const Uncertainty&, const Uncertainty&) = default;
};

}  // namespace downwash
