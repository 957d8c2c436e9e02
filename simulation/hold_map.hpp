#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/hover_analysis.hpp"

namespace downwash {

/// Where a vehicle can hover with one arm angle: a verdict for every node of a regular grid of the plane.
struct HoldMap {
    double arm_rad = 0;
    double x_low_m = 0, z_low_m = 0;  ///< place of the first node
    double step_m = 0;
    std::size_t columns = 0, rows = 0;  ///< nodes along x and z
    /// One entry a node, along x first.
    std::vector<HoldVerdict> verdicts;
    /// [1/s], of HoverStability; NaN where there is no equilibrium.
    std::vector<double> growth_rates_1_s;
};

/// The maximum number of nodes of a hold map.
inline constexpr double max_hold_nodes = 1048576;

/// Analyses hover at every node x_low + i step, z_low + k step within the bounds.
/// @param threads at least 1; the result does not depend on it
/// @throws InputError when the bounds are empty, the step is not a positive number, or there would be too many nodes
[[nodiscard]] DOWNWASH_EXPORT HoldMap make_hold_map(const FlightModel& model, const Bounds& bounds, double step_m,
                                                    double arm_rad, int threads = 1);

/// A point of the plane of motion [m].
struct HoldPoint {
    double x_m = 0, z_m = 0;
};

/// The lines between stable and unstable hover, as their crossings with the edges of the grid, to 1e-4 m. There is no
/// line where either side borders on another verdict (not flyable, no equilibrium, unknown). A closed line ends with
/// its first point.
/// @param model,map the map was made from this model
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<HoldPoint>> stability_boundary(const FlightModel& model,
                                                                                     const HoldMap& map);

}  // namespace downwash
