#pragma once

#include <algorithm>
#include <cstddef>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// An interval along a line, in metres from the line's point. Empty when low > high.
struct Interval {
    double low = 1;
    double high = -1;
    [[nodiscard]] bool empty() const noexcept { return low > high; }
};

/// A world-aligned box [m].
struct BoundingBox {
    Vector3 low_m, high_m;

    /// The smallest one that holds two points.
    [[nodiscard]] static BoundingBox around(const Vector3& a, const Vector3& b) noexcept {
        BoundingBox both{a, a};
        both.include({b, b});
        return both;
    }
    /// Grows until it holds another box, or a point given as both corners of one.
    void include(const BoundingBox& other) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            low_m[k] = std::min(low_m[k], other.low_m[k]);
            high_m[k] = std::max(high_m[k], other.high_m[k]);
        }
    }
};

}  // namespace downwash
