#pragma once

// Private: not installed.

#include <algorithm>
#include <array>
#include <cstddef>

#include "downwash/base/lane_math.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {

/// Where the robot is at a start.
[[nodiscard]] inline SpacePose pose_at(const SpaceStart& start) {
    SpacePose pose;
    pose.position_m = start.position_m;
    if (start.attitude) {
        pose.attitude = normalised(*start.attitude);
    } else {
        const auto [sine, cosine] = lane::sin_cos(start.yaw_rad / 2);
        pose.attitude = {cosine, 0, 0, sine};
    }
    std::copy_n(start.joints_rad.begin(), std::min(start.joints_rad.size(), max_links), pose.joints_rad.begin());
    return pose;
}

}  // namespace downwash
