#pragma once

#include <cmath>

#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_reference.hpp"

namespace downwash::controllers {

inline constexpr int axes = space_axes<max_joints>;

/// x, y and z of an array over axes.
inline Vector3 translation(const double (&axis)[axes]) {
    return {axis[space::x], axis[space::y], axis[space::z]};
}

inline double length(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

}  // namespace downwash::controllers
