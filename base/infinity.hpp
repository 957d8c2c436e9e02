#pragma once

#include <limits>

namespace downwash {

/// What is farther, later or dearer than everything.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace downwash
