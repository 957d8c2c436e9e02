#pragma once

#include "downwash/base/spread.hpp"

namespace downwash {

/// What is not known exactly of a vehicle and its sensors, and how well it is known: docs/model.md 9 says where the
/// defaults come from.
struct RobotUncertainty {
    Spread mass_scale = Spread::of_sd(0.02);
    Spread inertia_scale = Spread::of_sd(0.05);
    Spread arm_mass_scale = Spread::of_sd(0.05);
    Spread center_of_mass_x_m = Spread::of_sd(0.005);
    Spread center_of_mass_z_m = Spread::of_sd(0.005);
    Spread thrust_scale = Spread::of_sd(0.03);
    Spread rotor_thrust_scale = Spread::of_sd(0.01);             ///< of each rotor for itself
    Spread rotor_time_constant_s = Spread::of_factor(0.7, 1.5);  ///< a range is one of the time constant itself
    Spread delay_s = Spread::of_factor(0.5, 1.5);                ///< a range is one of the delay itself

    Spread position_bias_m = Spread::of_sd(0.01);  ///< of x and z, each for itself
    Spread pitch_bias_rad = Spread::of_sd(0.005235987755982988);
    Spread position_noise_m = Spread::of_sd(0.005);  ///< only the sd of a noise has a meaning
    Spread velocity_noise_m_s = Spread::of_sd(0.02);
    Spread gyro_noise_rad_s = Spread::of_sd(0.015);

    friend constexpr bool operator==(const RobotUncertainty&, const RobotUncertainty&) = default;
};

}  // namespace downwash
