#pragma once

namespace downwash {

/// Degrees are for people to read and write; code computes in radians.
inline constexpr double degrees_per_radian = 57.295779513082320877;

}  // namespace downwash
