#pragma once

// Private to planner/.

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// From the origin [m]; farther out, positions lose their millimetres.
inline constexpr double farthest_m = 1e5;

/// Adds environment.obstacles with everything in it to a problem's table.
void add_obstacle_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
