#pragma once

#include <array>

namespace downwash {

/// Three coordinates or angles; the name of the variable says which frame and unit.
using Vector3 = std::array<double, 3>;

/// A 3x3 matrix by rows.
using Matrix3 = std::array<Vector3, 3>;

}  // namespace downwash
