#pragma once

// Private to planner/.

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Adds aero with everything in it to a problem's table.
/// @pre the rows of environment.plane stand before: a grid in plane coordinates is read with that plane
void add_aero_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
