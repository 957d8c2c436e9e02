#pragma once

#include <cmath>

#include "downwash/base/direction.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash::robot_import {

// Operators of this namespace would hide those for vectors.
using downwash::operator+;
using downwash::operator-;
using downwash::operator*;

[[nodiscard]] inline Matrix3 identity() noexcept {
    return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

[[nodiscard]] inline Matrix3 transposed(const Matrix3& m) noexcept {
    return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

[[nodiscard]] inline Matrix3 operator*(const Matrix3& a, const Matrix3& b) noexcept {
    const Matrix3 columns = transposed(b);
    Matrix3 product;
    for (std::size_t i = 0; i < 3; ++i) {
        product[i] = {dot(a[i], columns[0]), dot(a[i], columns[1]), dot(a[i], columns[2])};
    }
    return product;
}

[[nodiscard]] inline Matrix3 operator+(const Matrix3& a, const Matrix3& b) noexcept {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// The rotation about an axis by an angle, by Rodrigues' formula. @pre the axis has a direction
[[nodiscard]] inline Matrix3 rotation_about(const Vector3& axis, double angle_rad) noexcept {
    const Vector3 a = unit(axis);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad), v = 1 - c;
    return {{{c + v * a[0] * a[0], v * a[0] * a[1] - s * a[2], v * a[0] * a[2] + s * a[1]},
             {v * a[0] * a[1] + s * a[2], c + v * a[1] * a[1], v * a[1] * a[2] - s * a[0]},
             {v * a[0] * a[2] - s * a[1], v * a[1] * a[2] + s * a[0], c + v * a[2] * a[2]}}};
}

/// A place and axes within others: x_outer = rotation x_inner + position_m.
struct RigidTransform {
    Matrix3 rotation = identity();
    Vector3 position_m{};

    [[nodiscard]] Vector3 placed(const Vector3& inner_m) const noexcept { return rotation * inner_m + position_m; }
    [[nodiscard]] RigidTransform operator*(const RigidTransform& inner) const noexcept {
        return {rotation * inner.rotation, placed(inner.position_m)};
    }
    [[nodiscard]] RigidTransform inverse() const noexcept {
        const Matrix3 back = transposed(rotation);
        return {back, -1.0 * (back * position_m)};
    }
};

}  // namespace downwash::robot_import
