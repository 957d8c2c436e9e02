#pragma once

namespace downwash {

/// For people to read and write; computing is done in radians.
inline constexpr double degrees_per_radian = 57.295779513082320877;

}  // namespace downwash
