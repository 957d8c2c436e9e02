#pragma once

#include <array>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_robot.hpp"

// Where the parts of a robot in space are that goals ask for.

namespace downwash {

/// The end effector of a robot.
struct SpaceToolPose {
    Vector3 position_m{};
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< of the last link's axes or, without an arm, the multirotor's
    Vector3 direction{};                         ///< where it points, of length 1
};

/// The axes of a link (-1: the multirotor) at a pose, as a quaternion of length 1, and the origin of its frame.
struct SpaceLinkPose {
    Vector3 origin_m{};
    std::array<double, 4> attitude{1, 0, 0, 0};

    /// A point in the axes of the link, from its origin.
    [[nodiscard]] Vector3 placed(const Vector3& at_m) const noexcept { return origin_m + rotation_of(attitude) * at_m; }
};

/// @param link -1 to robot.joints() - 1
[[nodiscard]] DOWNWASH_EXPORT SpaceLinkPose link_at(const SpaceRobot& robot, const SpacePose& pose, int link);

[[nodiscard]] DOWNWASH_EXPORT SpaceToolPose tool_at(const SpaceRobot& robot, const SpacePose& pose);

/// The heading of an attitude: that of its x axis in the level [rad].
[[nodiscard]] DOWNWASH_EXPORT double yaw_of(const std::array<double, 4>& attitude) noexcept;

/// R = Rz(yaw) Ry(pitch) Rx(roll) as a quaternion.
[[nodiscard]] DOWNWASH_EXPORT std::array<double, 4> attitude_of(const Vector3& rpy_rad) noexcept;

/// The angle between two vectors of any length but zero, 0 to pi [rad].
[[nodiscard]] DOWNWASH_EXPORT double angle_between_rad(const Vector3& a, const Vector3& b) noexcept;

}  // namespace downwash
