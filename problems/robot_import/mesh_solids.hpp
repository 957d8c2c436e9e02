#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/robot_import/kinematic_tree.hpp"

namespace downwash::robot_import {

/// Reads the pieces of all meshes that shapes of links name. What cannot be read keeps none.
void read_meshes(KinematicTree& tree);

/// Joins pieces of a mesh until each group is worth a solid of its own: those with little space between them, or one
/// within the other, and then, while there are more than most_groups, those with the least space.
/// @pre no piece is empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<Vector3>> joined_pieces(std::vector<std::vector<Vector3>> pieces);

/// More solids for one mesh would make flights slow.
inline constexpr std::size_t most_groups = 8;

}  // namespace downwash::robot_import
