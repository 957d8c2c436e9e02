#pragma once

#include "downwash/base/vector3.hpp"

namespace downwash {

/// Whether a vector of any unit is long enough for a direction. What is shorter than 1e-6 was meant to be zero, and the
/// square of what is much shorter is no longer above 0. False for NaN.
[[nodiscard]] inline bool has_direction(const Vector3& v) noexcept {
    constexpr double least_square = 1e-12;
    return dot(v, v) >= least_square;
}

}  // namespace downwash
