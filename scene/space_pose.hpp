#pragma once

#include <array>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/space_robot_shape.hpp"

namespace downwash {

/// Where a robot in space is.
struct SpacePose {
    Vector3 position_m{};  ///< of the multirotor's centre of mass in the world
    /// Quaternion (w, x, y, z) from body axes to world axes; of any length but zero.
    std::array<double, 4> attitude{1, 0, 0, 0};
    std::array<double, max_links> joints_rad{};  ///< at most 1e5 each; those that the robot lacks say nothing

    friend bool operator==(const SpacePose&, const SpacePose&) = default;
};

/// From the frame that a quaternion turns to the outer one. @param q (w, x, y, z) of any length but zero
[[nodiscard]] inline Matrix3 rotation_of(const std::array<double, 4>& q) noexcept {
    const double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double sx = s * q[1], sy = s * q[2], sz = s * q[3];
    const double wx = q[0] * sx, wy = q[0] * sy, wz = q[0] * sz;
    const double xx = q[1] * sx, xy = q[1] * sy, xz = q[1] * sz;
    const double yy = q[2] * sy, yz = q[2] * sz, zz = q[3] * sz;
    return {{{1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}}};
}

/// A quaternion brought to length 1.
[[nodiscard]] inline std::array<double, 4> normalised(const std::array<double, 4>& q) noexcept {
    const double length = lane::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

/// The pose halfway between two: position and joints change evenly, and the attitude turns the shorter way about a
/// fixed axis at an even rate.
[[nodiscard]] inline SpacePose halfway(const SpacePose& from, const SpacePose& to) noexcept {
    SpacePose middle;
    middle.position_m = 0.5 * (from.position_m + to.position_m);
    for (std::size_t i = 0; i < max_links; ++i) {
        middle.joints_rad[i] = 0.5 * (from.joints_rad[i] + to.joints_rad[i]);
    }
    const std::array<double, 4> a = normalised(from.attitude), b = normalised(to.attitude);
    const double sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
    middle.attitude = normalised({a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2], a[3] + sign * b[3]});
    return middle;
}

}  // namespace downwash
