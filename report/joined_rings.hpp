#pragma once

// Private: not installed.

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Joins polygons that share whole edges, such as the sections of an octree's cubes: shared edges vanish, and so do
/// corners on straight lines. What is left are outlines, counter-clockwise, and the holes in them, the other way round.
/// @param rings counter-clockwise, none over another; corners within 1e-7 m of each other count as one
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<PlanePoint>> joined_rings(
    const std::vector<std::vector<PlanePoint>>& rings);

}  // namespace downwash
