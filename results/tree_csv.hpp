#pragma once

#include <span>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/results/number_table.hpp"

namespace downwash {

/// The text of tree.csv: a header, then a row per node with its place and the row of its parent, counted from 0 (empty:
/// a root). Every number is the shortest that reads back as the very same.
/// @param axes of the problem
[[nodiscard]] DOWNWASH_EXPORT std::string tree_csv(std::span<const TreeNode> tree, std::span<const Axis> axes);
[[nodiscard]] DOWNWASH_EXPORT std::string tree_csv(std::span<const SpaceTreeNode> tree, std::span<const Axis> axes);

/// The numbers of a tree as a table; the parent of a root is NaN.
[[nodiscard]] DOWNWASH_EXPORT NumberTable tree_table(std::span<const TreeNode> tree, std::span<const Axis> axes);
[[nodiscard]] DOWNWASH_EXPORT NumberTable tree_table(std::span<const SpaceTreeNode> tree, std::span<const Axis> axes);

}  // namespace downwash
