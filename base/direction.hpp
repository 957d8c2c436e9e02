#pragma once

#include <algorithm>
#include <cmath>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// Whether a vector of any unit is long enough for a direction. What is shorter than 1e-6 was meant to be zero, and the
/// square of what is much shorter is no longer above 0. False for NaN.
[[nodiscard]] inline bool has_direction(const Vector3& v) noexcept {
    constexpr double least_square = 1e-12;
    return dot(v, v) >= least_square;
}

[[nodiscard]] inline double length_of(const Vector3& v) noexcept {
    return std::sqrt(dot(v, v));
}

/// A vector over its length, first scaled so that no square over- or underflows. @pre it is not zero
[[nodiscard]] inline Vector3 unit(const Vector3& v) noexcept {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    const Vector3 scaled{v[0] / largest, v[1] / largest, v[2] / largest};
    return (1 / length_of(scaled)) * scaled;
}

/// A vector of length 1 across another one of length 1.
[[nodiscard]] inline Vector3 across(const Vector3& v) noexcept {
    return unit(cross(v, std::abs(v[0]) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0}));
}

}  // namespace downwash
