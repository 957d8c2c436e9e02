#pragma once

#include <algorithm>
#include <array>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {

/// Where a level robot in space and its arm are: x, y, z [m], yaw and joints [rad], in the order of SpacePoint. Joints
/// that it lacks stay at zero.
using SpaceConfiguration = std::array<double, space_axes<max_joints>>;

/// The configuration of a reference point.
[[nodiscard]] inline SpaceConfiguration configuration_of(const SpacePoint& point) noexcept {
    SpaceConfiguration all{};
    std::copy_n(point.position, all.size(), all.begin());
    return all;
}

/// The level robot.
[[nodiscard]] inline SpacePose level_at(const SpaceConfiguration& at) noexcept {
    SpacePose pose;
    std::copy_n(at.begin(), 3, pose.position_m.begin());
    const auto [sine, cosine] = lane::sin_cos(0.5 * at[space::yaw]);
    pose.attitude = {cosine, 0, 0, sine};
    std::copy_n(at.begin() + space::first_joint, max_joints, pose.joints_rad.begin());
    return pose;
}

}  // namespace downwash
