#pragma once

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Adds uncertainty with everything in it to a problem's table. It begins with what the robot says of itself.
/// @pre the robot's rows come before: keys are read in the order of the table
void add_uncertainty_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
