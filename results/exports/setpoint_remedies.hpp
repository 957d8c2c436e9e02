#pragma once

// Private: not installed.

#include <string>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// How vectors that do not fit others would: shifted, turned about z, or with other axes ("; all would fit as (y, x,
/// -z)..."). If they do fit, only their integral does not. Empty if nothing of this helps.
/// @param tolerance of a distance   @param may_be_shifted whether they have an origin
[[nodiscard]] std::string axes_remedy(const std::vector<Vector3>& found, const std::vector<Vector3>& expected,
                                      double tolerance, bool may_be_shifted);

/// How angles that do not fit others would: with the other sign, turned, or in degrees.
/// @param tolerance_rad of a difference, of which whole turns do not count
[[nodiscard]] std::string angle_remedy(const std::vector<double>& found, const std::vector<double>& expected,
                                       double tolerance_rad);

/// How rates or accelerations that do not fit others would: with the other sign, or in degrees.
[[nodiscard]] std::string rate_remedy(const std::vector<double>& found, const std::vector<double>& expected,
                                      double tolerance);

}  // namespace downwash
