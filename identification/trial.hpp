#pragma once

#include <array>
#include <vector>

#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world_description.hpp"

// Private to identification/.

namespace downwash::identification {

/// A vehicle and its surroundings with one choice of everything that is identified.
struct Trial {
    SpaceRobot robot;                     ///< with the drag of this trial
    SpaceWorld world;                     ///< the other differences from the robot file
    std::vector<double> surface_effects;  ///< K - 1 at each node of z/R
};

/// What is measured, in groups of equal noise.
enum class Channel { position, attitude, joints, velocity, body_rates, joint_rates };
inline constexpr std::size_t channel_count = 6;

/// A number for each of them; variances are in SI units.
using PerChannel = std::array<double, channel_count>;

/// What moves a vehicle beside what is modelled, as white noise: linear, angular and joint accelerations.
inline constexpr std::size_t acceleration_count = 3;

/// The noise of a log.
struct Noise {
    PerChannel measured{};  ///< variances of what is measured
    /// Variances of the rates' change per second, of each axis.
    std::array<double, acceleration_count> accelerations{};
};

}  // namespace downwash::identification
