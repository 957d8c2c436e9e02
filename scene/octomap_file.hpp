#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Reads the occupied space of an octree that OctoMap wrote: binary (.bt) or with probabilities (.ot, little-endian,
/// id OcTree or ColorOcTree, whose colours are passed over). A leaf of probability 0.5 or more is occupied. The first
/// line of the file gives its format. Each occupied leaf becomes a cube; a leaf pruned n levels above the deepest one
/// has a side of 2^n times the resolution. Free leaves tell with the occupied ones what was seen; space without a leaf
/// was not (OccupancyTree::unseen). (Hornung et al. 2013, OctoMap 1.9.7's readBinaryNode and readNodesRecurs.)
///
/// One walk checks the stream of nodes and makes the cubes; docs/dependencies.md says why OctoMap does not read it.
/// A file is rejected if it has more than 512 MiB, a resolution outside 0.0001 to 30 m (at which the farthest corners
/// are 1e6 m away), nodes nested deeper than 16 levels, another number of nodes than it states, bytes left over, values
/// that are not probabilities, or none or more than 2,000,000 occupied leaves.
/// @throws InputError "'file' line 3: what is wrong, what was expected", "byte 84" among the nodes
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const OccupancyTree> read_octomap(const std::filesystem::path& file);

/// Reads an OctoMap file from bytes in memory; the name is for messages. @throws InputError
[[nodiscard]] DOWNWASH_EXPORT OccupancyTree parse_octomap(std::string_view bytes, const std::string& name);

}  // namespace downwash
