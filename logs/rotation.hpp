#pragma once

#include <array>
#include <cmath>

#include "downwash/base/vector3.hpp"

// Attitudes as logs write them.

namespace downwash {

/// The quaternion (w, x, y, z) from body to world axes of roll, pitch and yaw [rad]: R = Rz(yaw) Ry(pitch) Rx(roll), in
/// whatever axes they are.
[[nodiscard]] inline std::array<double, 4> quaternion_of_angles(double roll_rad, double pitch_rad,
                                                                double yaw_rad) noexcept {
    const double cr = std::cos(roll_rad / 2), sr = std::sin(roll_rad / 2);
    const double cp = std::cos(pitch_rad / 2), sp = std::sin(pitch_rad / 2);
    const double cy = std::cos(yaw_rad / 2), sy = std::sin(yaw_rad / 2);
    return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy};
}

/// A vector of the body in world axes. @param q of length 1
[[nodiscard]] inline Vector3 rotated(const std::array<double, 4>& q, const Vector3& of_body) noexcept {
    const Vector3 axis{q[1], q[2], q[3]};
    const Vector3 twice = 2.0 * cross(axis, of_body);
    return of_body + q[0] * twice + cross(axis, twice);
}

}  // namespace downwash
