#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/field_figure.hpp"

namespace downwash {

/// A velocity (along x, along z) at (x, z), in any unit.
using PlanarVelocity = std::function<std::array<double, 2>(double x, double z)>;

/// The streamline through a point, downstream from it, as points `step` apart, integrated along its length by the
/// classical Runge-Kutta method. It ends where it leaves the extent, where the velocity vanishes or is not
/// finite, or after 10000 steps. @pre step > 0
[[nodiscard]] DOWNWASH_EXPORT std::vector<PlanePoint> streamline(const PlanarVelocity& velocity,
                                                                 const PlanePoint& start, const Bounds& extent,
                                                                 double step);

/// A picture of a flow: the velocity along z as colours, and streamlines from these points. The caller sets titles
/// and axes. @param scale of the velocity along z  @pre the extent is not empty
[[nodiscard]] DOWNWASH_EXPORT FieldFigure flow_figure(const PlanarVelocity& velocity, const Bounds& extent,
                                                      const std::vector<PlanePoint>& starts, ColorScale scale);

}  // namespace downwash
