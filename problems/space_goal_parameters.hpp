#pragma once

// Private to problems/.

#include <functional>
#include <string>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Adds goal with everything in it to the table of a problem in space.
void add_space_goal_rows(std::vector<Parameter<SpaceProblem>>& rows);

/// Name of the group of keys that a kind of goal has: "end_effector".
[[nodiscard]] std::string_view name_of(const SpaceGoalKind& kind);

/// Calls visit(goal, key of its kind) for every goal without alternatives, and for every alternative of the others.
void for_each_goal(const SpaceProblem& problem,
                   const std::function<void(const SpaceGoal& goal, const std::string& key)>& visit);

}  // namespace downwash
