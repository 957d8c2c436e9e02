#pragma once

// Private to aeromap.

#include <cstddef>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The raster of one layer: what a builder needs to know of the map.
struct LayerGrid {
    const DirectEffect& effect;
    const PlaneOfMotion& plane;
    double lateral_m;
    double x_low_m, z_low_m;
    double side_m;
    std::size_t columns, rows;
    const StopCondition& is_over;  ///< asked before K or a clearance is evaluated
};

/// Some columns of a layer, [first, last); none if the last is not beyond the first.
struct ColumnRange {
    std::size_t first, last;
};

}  // namespace downwash
