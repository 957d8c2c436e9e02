#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Reads the occupied space of an octree that OctoMap wrote: binary (.bt) or with probabilities (.ot, little-endian,
/// id OcTree), where a leaf of probability 0.5 or more is occupied. The first line of the file says which it is.
/// Each occupied leaf becomes a cube, one pruned n levels above the deepest with 2^n times the resolution as its side;
/// space that is free or unknown does not. (Hornung et al. 2013, OctoMap 1.9.7's readBinaryNode and readNodesRecurs.)
///
/// The stream of nodes is checked in one walk, and that walk already gives the cubes: no library has to read it again.
/// A file of more than 512 MiB, with a resolution outside 0.0001 to 30 m (at which the farthest corners are 1e6 m
/// away), nodes nested deeper than 16 levels, another number of nodes than it says, bytes left over, probabilities that
/// are none, or none or more than 2,000,000 occupied leaves is refused.
/// @throws InputError "'file' line 3: what is wrong, what was expected", "byte 84" among the nodes
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const OccupancyTree> read_octomap(const std::filesystem::path& file);

/// The same for bytes that stand in memory; the name is for messages. @throws InputError
[[nodiscard]] DOWNWASH_EXPORT OccupancyTree parse_octomap(std::string_view bytes, const std::string& name);

}  // namespace downwash
