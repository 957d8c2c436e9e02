#pragma once

#include <functional>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/grids/factor_grid.hpp"

namespace downwash {

/// Where a grid is sampled. The spacing is rounded down so that the last node is at the upper end.
struct GridSampling {
    PlaneOfMotion plane;
    Bounds extent;
    double step_m = 0;  ///< maximum distance between neighbouring nodes, > 0
    int threads = 1;
    std::function<void(double)> on_progress;  ///< see run_parallel
};

/// Samples K, its two one-sided factors and the flyable area directly on planes, one for each lateral offset.
/// @param layers of distinct lateral offsets, in any order
/// @throws InputError if the extent is empty, two layers share an offset, or the grid would have too many nodes
[[nodiscard]] DOWNWASH_EXPORT FactorGrid sample_planes(std::vector<MapLayer> layers, const GridSampling& sampling,
                                                       const Provenance& provenance = {});

/// Samples the effect in a volume around the plane, from `lateral_low_m` to `lateral_high_m` to its left.
[[nodiscard]] DOWNWASH_EXPORT FactorGrid sample_volume(const DirectEffect& effect, double lateral_low_m,
                                                       double lateral_high_m, const GridSampling& sampling,
                                                       const Provenance& provenance = {});

/// Where the effect comes from: models with parameters and sources, radius and the other settings.
[[nodiscard]] DOWNWASH_EXPORT Provenance provenance_of(const DirectEffect& effect);

}  // namespace downwash
