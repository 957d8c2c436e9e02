#pragma once

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Appends the rows of `goal`: one goal, a list of goals, a choice of them, or targets in any order.
void add_goal_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
