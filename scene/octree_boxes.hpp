#pragma once

// Private to scene/.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Cells `low` to `high` - 1 of a grid whose cells have a side of `side_m`, counted from the origin.
struct CellBlock {
    double side_m;
    std::array<std::int64_t, 3> low, high;
};

/// Boxes that fill exactly what the blocks fill: neighbours on the same grid that agree in two directions become one.
[[nodiscard]] std::vector<LocalBox> merged_boxes(std::vector<CellBlock> blocks);

/// Boxes that fill exactly what the cubes fill: neighbours of equal size in a row, rows in a slab and slabs in a block
/// become one box. Cubes that do not lie on the grid of their size stay as they are.
[[nodiscard]] DOWNWASH_EXPORT std::vector<LocalBox> merged_boxes(const std::vector<OccupiedCube>& cubes);

/// The solid boxes of an octree: its merged cubes and, where it counts as occupied, the unseen space.
[[nodiscard]] DOWNWASH_EXPORT std::vector<LocalBox> solid_boxes(const Octomap& octomap);

}  // namespace downwash
