#pragma once

#include <functional>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The thrust ratio K of a rotor over the place (x, z) of its hub in the plane of motion [m], for figures; NaN where it
/// is not flyable. Evaluated directly: a map may be off by 0.01, as much as a class of factor_scale().
[[nodiscard]] DOWNWASH_EXPORT std::function<double(double x_m, double z_m)> factor_field(const MapLayer& layer,
                                                                                         const PlaneOfMotion& plane);

/// The minimum and maximum of a figure's thrust ratios and of 1, for factor_scale(): over the extent of the whole
/// problem, so that parts of it have the same scale, and over the shown one.
[[nodiscard]] DOWNWASH_EXPORT AxisRange factor_range(const FieldFigure& figure, const Bounds& problem_extent);

}  // namespace downwash
