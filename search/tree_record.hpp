#pragma once

#include <ompl/base/Planner.h>

#include <functional>
#include <vector>

#include "downwash/search/search_record.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// What a planner of OMPL's kind has grown: nodes in the order in which it lists them, each with the next on the way
/// back to the start, or to the goal where a tree grows from there. What hangs together with neither is left out.
/// @param place where a state of the planner's space is
[[nodiscard]] std::vector<TreeNode> tree_of(const ompl::base::Planner& planner,
                                            const std::function<Configuration(const ompl::base::State*)>& place);

}  // namespace downwash::planning
