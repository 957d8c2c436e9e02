#pragma once

#include <functional>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// The boundary of a region of the plane as lines; closed ones repeat their first point. The region is sampled in the
/// corners of columns x rows cells of the extent, and the boundary is located to a thousandth of a cell between corners
/// that differ (grid_contour). Parts smaller than a cell may be missed.
/// @param contains whether a point belongs to the region  @pre columns and rows at least 1
[[nodiscard]] DOWNWASH_EXPORT std::vector<Ring> region_boundary(
    const std::function<bool(double x_m, double z_m)>& contains, const Bounds& extent, std::size_t columns,
    std::size_t rows);

}  // namespace downwash
