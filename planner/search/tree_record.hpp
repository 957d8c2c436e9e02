#pragma once

#include <ompl/base/Planner.h>

#include <functional>
#include <vector>

#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// The tree that an OMPL planner has grown: nodes in the order in which it lists them. The parent of a node is the next
/// one on the way back to the start, or to the goal where a tree grows from there. Nodes that are connected to neither
/// are left out.
/// @param place where a state of the planner's space is
template <class Configuration>
[[nodiscard]] std::vector<BasicTreeNode<Configuration>> tree_of(
    const ompl::base::Planner& planner, const std::function<Configuration(const ompl::base::State*)>& place);

}  // namespace downwash::planning
