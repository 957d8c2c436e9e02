#pragma once

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Goals that none of some configurations meets freely, of alternatives all: see goal_reach(). Goals of which none of
/// some free configurations can be got to from the start, as is proven: see way_of_ball().
/// @pre space_problem_errors(problem) is empty
[[nodiscard]] std::vector<KeyError> space_goal_warnings(const SpaceProblem& problem);

}  // namespace downwash
