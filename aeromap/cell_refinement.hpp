#pragma once

// Private to aeromap.

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace downwash {

inline constexpr int max_steps = 512;

/// How finely one map cell is divided along x and z; powers of two up to max_steps.
struct CellSteps {
    std::uint16_t x = 1, z = 1;
};

/// A square cell in plane coordinates [m].
struct CellSquare {
    double x_low_m, z_low_m;
    double side_m;
};

/// What is interpolated.
struct CellField {
    std::function<double(double x_m, double z_m)> factor;
    /// Whether every position within `reach_m` of (x, z) is forbidden: there K does not matter and is not asked for.
    /// Empty: the whole cell is flyable.
    std::function<bool(double x_m, double z_m, double reach_m)> is_forbidden_around;
    /// Between positions that are this far apart K may rise and fall again unseen: everything longer is looked into.
    double shortest_turn_m = std::numeric_limits<double>::infinity();
};

/// The cheapest division whose bilinear interpolation error in the flyable part is estimated below 0.0065, which
/// leaves a third of the promised 0.01 for what hides between the probes. Where even max_steps do not reach it the
/// most exact division.
[[nodiscard]] CellSteps steps_for(const CellSquare& cell, const CellField& field);

/// Appends the (steps.x + 1)(steps.z + 1) node values of a cell, x running fastest; 1 where no flyable position is
/// interpolated with the node.
void append_nodes(const CellSquare& cell, const CellSteps& steps, const CellField& field, std::vector<float>& nodes);

}  // namespace downwash
