#pragma once

#include "downwash/controllers/axes.hpp"

namespace downwash {

/// Where vehicle and arm should be at one instant: the coordinate of each axis [m or rad] with its first and second
/// time derivative. Angles are unwrapped. One template over the lane type.
template <class T>
struct BasicReferencePoint {
    T position[max_axes]{};
    T velocity[max_axes]{};
    T acceleration[max_axes]{};

    friend bool operator==(const BasicReferencePoint&, const BasicReferencePoint&) = default;
};

/// The reference point of a single vehicle.
using ReferencePoint = BasicReferencePoint<double>;

}  // namespace downwash
