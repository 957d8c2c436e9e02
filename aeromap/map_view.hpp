#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace downwash {

/// Whether a whole map cell lies inside the flyable area, outside it, or needs the exact test.
enum class CellFlyability : std::uint8_t { flyable, forbidden, mixed };

/// Which sides matter in a whole map cell: the other one changes K by no more than 0.002 there.
enum class CellSides : std::uint8_t { below, above, both };

/// A cell of a layer: where its grid of values begins, and how fine it is.
struct MapCell {
    std::uint32_t first_node;
    std::uint16_t steps_x;  ///< intervals along x, a power of two
    std::uint16_t steps_z;  ///< intervals along z, a power of two
};

/// Values of one kind that a cell has.
[[nodiscard, gnu::always_inline]] inline std::size_t node_count(const MapCell& cell) noexcept {
    return (cell.steps_x + std::size_t{1}) * (cell.steps_z + std::size_t{1});
}

/// A layer of an AeroMap as plain arrays, for code that follows flights through it. Functions that kernels for wide
/// instructions call are always inlined, so that no copy that only some processors can run reaches the linker.
struct MapView {
    double x_low_m, z_low_m, cells_per_m;
    std::uint32_t columns, rows;
    const MapCell* cells;              ///< x running fastest
    const CellFlyability* flyability;  ///< one for each cell
    const CellSides* sides;            ///< one for each cell
    /// K, x running fastest within a cell. Behind it, where both sides matter, as many values of the surfaces above.
    const float* nodes;

    /// Whether a place, in cells from the lower corner, has a cell; false for NaN.
    [[nodiscard, gnu::always_inline]] bool contains(double u, double w) const noexcept {
        return u >= 0 && w >= 0 && u < columns && w < rows;
    }
};

/// One interval of a cell's grid, between four neighbouring values, where K is bilinear. A flight stays in one for
/// several ticks and saves the look-up.
struct MapPatch {
    double u, w;                ///< its lower corner, in cells from that of the layer
    double steps_x, steps_z;    ///< patches per cell
    double corner[4];           ///< K at the lower left, lower right, upper left and upper right
    double above[4];            ///< K of the surfaces above alone
    CellFlyability flyability;  ///< the flyability of the cell
};

/// A patch without any place in it.
inline constexpr MapPatch no_patch{HUGE_VAL, HUGE_VAL, 1, 1, {}, {1, 1, 1, 1}, CellFlyability::mixed};

/// The patch around a place given in cells from the layer's lower corner.
/// @pre view.contains(u, w)
[[nodiscard, gnu::always_inline]] inline MapPatch patch_at(const MapView& view, double u, double w) noexcept {
    // u - i is exact and less than 1, and so is its product with a power of two: no index can leave its cell.
    const auto i = static_cast<std::uint32_t>(u);
    const auto k = static_cast<std::uint32_t>(w);
    const std::size_t number = std::size_t{k} * view.columns + i;
    const MapCell& cell = view.cells[number];
    const auto a = static_cast<std::uint32_t>((u - i) * cell.steps_x);
    const auto b = static_cast<std::uint32_t>((w - k) * cell.steps_z);
    const float* lower = view.nodes + cell.first_node + std::size_t{b} * (cell.steps_x + 1U) + a;
    const float* upper = lower + cell.steps_x + 1U;
    const double steps_x = cell.steps_x;
    const double steps_z = cell.steps_z;
    MapPatch patch{i + a / steps_x,  // exact, as all that follows from it
                   k + b / steps_z,        steps_x, steps_z, {lower[0], lower[1], upper[0], upper[1]}, {1, 1, 1, 1},
                   view.flyability[number]};
    if (view.sides[number] != CellSides::below) {
        const std::size_t behind = view.sides[number] == CellSides::both ? node_count(cell) : 0;
        lower += behind;
        upper += behind;
        patch.above[0] = lower[0];
        patch.above[1] = lower[1];
        patch.above[2] = upper[0];
        patch.above[3] = upper[1];
    }
    return patch;
}

/// K at the share (s, t) of a patch, each in [0, 1). One template over the lane type.
template <class T>
T bilinear(const T corner[4], T s, T t) {
    const T low = corner[0] + s * (corner[1] - corner[0]);
    const T high = corner[2] + s * (corner[3] - corner[2]);
    return low + t * (high - low);
}

}  // namespace downwash
