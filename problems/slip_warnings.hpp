#pragma once

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Values of a robot that are likely in another unit: limits in radians, places and inertias that do not fit its size.
/// Keys are those of a robot file.
[[nodiscard]] std::vector<KeyError> robot_slips(const Robot& robot);

/// Values of a problem that are likely in another unit: angles in radians, an energy that no hover can do with.
[[nodiscard]] std::vector<KeyError> problem_slips(const Problem& problem);

}  // namespace downwash
