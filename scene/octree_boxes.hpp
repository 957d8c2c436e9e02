#pragma once

// Private to scene/.

#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// A box in the local frame.
struct LocalBox {
    Vector3 center_m, size_m;
};

/// Boxes that fill exactly what the cubes fill: neighbours of equal size in a row, rows in a slab and slabs in a block
/// become one box. Cubes that do not lie on the grid of their size stay as they are.
[[nodiscard]] DOWNWASH_EXPORT std::vector<LocalBox> merged_boxes(const OccupancyTree& tree);

}  // namespace downwash
