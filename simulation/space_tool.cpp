#include "downwash/simulation/space_tool.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

using Quaternion = std::array<double, 4>;

/// First `b`, then `a`.
Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

}  // namespace

SpaceLinkPose link_at(const SpaceRobot& robot, const SpacePose& pose, int link) {
    SpaceLinkPose at{pose.position_m, normalised(pose.attitude)};
    for (std::size_t i = 0; i < static_cast<std::size_t>(link + 1); ++i) {
        const SpaceLink& next = robot.plant.links[i];
        at.origin_m = at.placed(next.joint_m);
        const auto [sine, cosine] = lane::sin_cos(0.5 * pose.joints_rad[i]);
        const Vector3 axis = sine * unit(next.axis);
        at.attitude = product(at.attitude, {cosine, axis[0], axis[1], axis[2]});
    }
    return at;
}

SpaceToolPose tool_at(const SpaceRobot& robot, const SpacePose& pose) {
    const SpaceLinkPose last = link_at(robot, pose, robot.joints() - 1);
    return {last.placed(robot.plant.end_effector_m), last.attitude,
            rotation_of(last.attitude) * unit(robot.tool_direction)};
}

double yaw_of(const std::array<double, 4>& q) noexcept {
    const Matrix3 axes = rotation_of(q);
    return lane::atan2(axes[1][0], axes[0][0]);
}

std::array<double, 4> attitude_of(const Vector3& rpy_rad) noexcept {
    const auto [sr, cr] = lane::sin_cos(0.5 * rpy_rad[0]);
    const auto [sp, cp] = lane::sin_cos(0.5 * rpy_rad[1]);
    const auto [sy, cy] = lane::sin_cos(0.5 * rpy_rad[2]);
    return {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr};
}

double angle_between_rad(const Vector3& a, const Vector3& b) noexcept {
    const Vector3 u = unit(a), v = unit(b);
    return lane::atan2(length_of(cross(u, v)), dot(u, v));
}

}  // namespace downwash
