#pragma once

#include <algorithm>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/space_configuration.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/space_tool.hpp"

// Where a vehicle in space is, in the words of goals, obstacles and references. pose.hpp has that of the plane.

namespace downwash {

/// The level vehicle at a configuration.
[[nodiscard]] inline SpacePose level_at(const SpaceConfiguration& at) noexcept {
    SpacePose pose;
    std::copy_n(at.coordinate.begin(), 3, pose.position_m.begin());
    const lane::SinCos half = lane::sin_cos(0.5 * at[space::yaw]);
    pose.attitude = {half.cosine, 0, 0, half.sine};
    std::copy_n(at.coordinate.begin() + space::first_joint, max_joints, pose.joints_rad.begin());
    return pose;
}

/// The same at rest.
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
    std::ranges::copy(motion.position_m, at.coordinate.begin());
    at[space::yaw] = yaw_of(motion.attitude);
    std::ranges::copy(motion.joints_rad, at.coordinate.begin() + space::first_joint);
    return at;
}

}  // namespace downwash
