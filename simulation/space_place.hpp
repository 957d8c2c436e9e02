#pragma once

#include <algorithm>

#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/space_tool.hpp"

// Where a vehicle in space is, in the words of goals, obstacles and references. pose.hpp has that of the plane.

namespace downwash {

/// The level vehicle at rest at a configuration.
[[nodiscard]] inline SpaceMotion resting_at(const SpaceConfiguration& at) noexcept {
    const SpacePose pose = level_at(at);
    SpaceMotion motion;
    motion.position_m = pose.position_m;
    motion.attitude = pose.attitude;
    motion.joints_rad = pose.joints_rad;
    return motion;
}

/// Where a vehicle is, and how it moves.
[[nodiscard]] inline SpaceMotion motion_of(const AnySpaceState& state) noexcept {
    const double* q = state.plant.q;
    const double* u = state.plant.u;
    SpaceMotion motion;
    std::copy_n(q, 3, motion.position_m.begin());
    std::copy_n(q + 3, 4, motion.attitude.begin());
    std::copy_n(q + 7, max_joints, motion.joints_rad.begin());
    std::copy_n(u, 3, motion.velocity_m_s.begin());
    std::copy_n(u + 3, 3, motion.body_rates_rad_s.begin());
    std::copy_n(u + 6, max_joints, motion.joint_rates_rad_s.begin());
    return motion;
}

/// The configuration of a vehicle, its tilt left out.
[[nodiscard]] inline SpaceConfiguration configuration_of(const SpaceMotion& motion) noexcept {
    SpaceConfiguration at;
    std::ranges::copy(motion.position_m, at.begin());
    at[space::yaw] = yaw_of(motion.attitude);
    std::ranges::copy(motion.joints_rad, at.begin() + space::first_joint);
    return at;
}

}  // namespace downwash
