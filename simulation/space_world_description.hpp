#pragma once

#include <cstdint>

#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/plant.hpp"

// What a world in space is: numbers alone. space_world.hpp prepares it for a flight.

namespace downwash {

/// A world in space: its differences from the nominal numbers, unknown to controller and planner. All zero is the
/// nominal world. docs/model.md 9.1 says what each of them changes. Axes are those of the world, x, y and z up, where
/// nothing else is said.
struct SpaceWorld {
    double ceiling_scale = 0;  ///< Relative change of K - 1 under surfaces.
    double ground_scale = 0;   ///< Relative change of K - 1 over surfaces.
    Vector3 scene_m = {};      ///< Displacement of all surfaces and obstacles, after their turn.
    double scene_yaw_rad = 0;  ///< Their turn about the z axis of the world, which is where its origin is.
    double mass_scale = 0;     ///< Relative change of the multirotor's mass.
    double inertia_scale = 0;  ///< Relative change of all inertias.
    double link_mass_scale[max_joints] = {};     ///< Relative change of the mass of each link.
    Vector3 center_of_mass_m = {};               ///< Place of the multirotor's centre of mass, in the body frame.
    double thrust_scale = 0;                     ///< Relative change of the thrust of all rotors.
    double rotor_thrust_scale[max_rotors] = {};  ///< Relative change of the thrust of each rotor.
    double wash_scale = 0;                       ///< Relative change of the slipstreams' speed at the links.
    double rotor_time_constant_s = 0;            ///< Added to that of the robot.
    double delay_s = 0;                          ///< Added to that of the robot.
    Vector3 position_bias_m = {};                ///< Constant error of the position that the controller sees.
    /// Constant error of the attitude that it sees: a turn about this axis of the body by its length [rad].
    Vector3 attitude_bias_rad = {};
    double joint_offset_rad[max_joints] = {};  ///< What it sees of each joint less its angle.
    Vector3 wind_m_s = {};                     ///< Steady wind.

    // Alike in every world of a problem but the nominal one.
    double position_noise_m = 0;  ///< Standard deviations of what the controller sees, anew in every tick.
    double velocity_noise_m_s = 0;
    double gyro_noise_rad_s = 0;
    double gust_m_s = 0;             ///< Standard deviation of the Dryden gusts, in every direction.
    double gust_length_level_m = 1;  ///< Length scales of the gusts along the ground, and upward.
    double gust_length_up_m = 1;

    std::uint64_t tape = 0;  ///< Selects the noise and the gusts.
};

}  // namespace downwash
