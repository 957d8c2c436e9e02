#pragma once

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Adds uncertainty with everything in it to a problem's table.
void add_uncertainty_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
