#pragma once

#include <memory>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// One layer of a map: an effect in the plane of motion shifted sideways.
struct MapLayer {
    std::shared_ptr<const DirectEffect> effect;
    double lateral_m = 0;  ///< to the left of the plane
};

/// The number of cells that a map would have, all layers together. A cell is grid_m wide, or a whole fraction of it for
/// steep models.
[[nodiscard]] DOWNWASH_EXPORT double map_cells(const std::vector<MapLayer>& layers, const Bounds& extent);

/// A map has no more cells than this: 2^24, some hundred megabytes.
inline constexpr double max_map_cells = 16777216;

}  // namespace downwash
