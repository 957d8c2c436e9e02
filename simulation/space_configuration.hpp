#pragma once

#include <algorithm>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/space_configuration.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {

/// The level robot at a configuration.
[[nodiscard]] inline SpacePose level_at(const SpaceConfiguration& at) noexcept {
    SpacePose pose;
    std::copy_n(at.begin(), 3, pose.position_m.begin());
    const auto [sine, cosine] = lane::sin_cos(0.5 * at[space::yaw]);
    pose.attitude = {cosine, 0, 0, sine};
    std::copy_n(at.begin() + space::first_joint, max_joints, pose.joints_rad.begin());
    return pose;
}

}  // namespace downwash
