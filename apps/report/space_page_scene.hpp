#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>

#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Adds to a page, in the coordinates of the world: scene, robot, start, goals, limits and facts of a problem in space.
/// @pre space_problem_errors(problem) is empty
void add_space_problem(nlohmann::ordered_json& page, const SpaceProblem& problem);

}  // namespace downwash
