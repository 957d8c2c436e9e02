#pragma once

#include <variant>

#include "downwash/dynamics/space_plant.hpp"

// The control laws of a vehicle in space, with their gains.

namespace downwash {

// (The helper who writes the laws replaces this file's gains by complete ones and documents them.)

/// Gains of a loop with position, velocity and integral.
struct SpaceLoopGains {
    double kp_1_s2 = 0, kd_1_s = 0, ki_1_s3 = 0;
    double integral_limit = 2;
};

/// Inverse dynamics with tilt first (docs/model.md 5.10).
struct SpaceInversion {
    SpaceLoopGains horizontal, height, joint;
    double attitude_kp_1_s = 0, yaw_kp_1_s = 0, rate_kp_1_s = 0, rate_ki_1_s2 = 0, yaw_rate_kp_1_s = 0;
    double max_rate_rad_s = 6, max_yaw_rate_rad_s = 2, max_tilt_rad = 0.61;
    double rotor_lead = 1, observer_gain_1_s = 0, min_vertical_force_ratio = 0.2;
    bool feed_forward = false;
};

/// PX4's cascade: position P, velocity PID, attitude P with the reduced attitude first, rates PID.
struct Px4Cascade {
    double position_p_1_s = 0, height_p_1_s = 0;
    SpaceLoopGains velocity, vertical_velocity, joint;
    double attitude_p_1_s = 0, yaw_weight = 0.4;
    SpaceLoopGains rate, yaw_rate;
};

using SpaceLaw = std::variant<SpaceInversion, Px4Cascade>;

/// The controller of a robot in space.
struct SpaceController {
    double rate_hz = 100;
    double delay_s = 0;  ///< age of the state that the law sees, at most 64 ticks; linear between ticks
    SpaceLaw law;
};

}  // namespace downwash
