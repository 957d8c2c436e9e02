#pragma once

#include <array>
#include <cmath>

namespace downwash {

/// Three coordinates or angles; the name of the variable says which frame and unit.
using Vector3 = std::array<double, 3>;

/// A 3x3 matrix by rows.
using Matrix3 = std::array<Vector3, 3>;

[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b) noexcept {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vector3 operator*(double s, const Vector3& a) noexcept {
    return {s * a[0], s * a[1], s * a[2]};
}
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline Vector3 operator*(const Matrix3& m, const Vector3& v) noexcept {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
[[nodiscard]] inline bool is_finite(const Vector3& v) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace downwash
