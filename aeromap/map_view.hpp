#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "downwash/base/export.hpp"

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

/// Eight by eight cells of a layer, and their values: what a map fills at once. Where the layer ends within a block,
/// the cells beyond its end are never looked up.
struct MapBlock {
    static constexpr std::uint32_t side_cells = 8;
    static constexpr std::uint32_t cell_count = side_cells * side_cells;

    MapCell cells[cell_count];              ///< x running fastest
    CellFlyability flyability[cell_count];  ///< one for each cell
    CellSides sides[cell_count];            ///< one for each cell
    /// K, x running fastest within a cell. Behind it, where both sides matter, as many values of the surfaces above.
    /// A cell that has the values of the one before it shares them.
    const float* nodes;
    std::uint32_t nodes_size;

    /// Number of the cell in column i and row k of the layer.
    [[nodiscard, gnu::always_inline]] static std::uint32_t cell_at(std::uint32_t i, std::uint32_t k) noexcept {
        return k % side_cells * side_cells + i % side_cells;
    }
};

class MapBlocks;

/// A layer of an AeroMap as plain arrays, for code that follows flights through it. Functions that kernels for wide
/// instructions call are always inlined, so that no copy that only some processors can run reaches the linker.
struct MapView {
    double x_low_m, z_low_m, cells_per_m;
    std::uint32_t columns, rows;    ///< of cells
    std::uint32_t block_columns;    ///< blocks side by side
    const MapBlock* const* blocks;  ///< the layer's blocks, x running fastest; null until somebody asks for one
    MapBlocks* source;              ///< who fills them
    std::size_t layer;

    /// Whether a place, in cells from the lower corner, has a cell; false for NaN.
    [[nodiscard, gnu::always_inline]] bool contains(double u, double w) const noexcept {
        return u >= 0 && w >= 0 && u < columns && w < rows;
    }
};

/// A block of a layer that may not be there yet. Any number of threads may ask; see BlockStore.
[[nodiscard]] DOWNWASH_EXPORT const MapBlock& filled_block(const MapView& view, std::size_t number);

/// The number of the block around a place given in cells from the layer's lower corner.
/// @pre view.contains(u, w)
[[nodiscard, gnu::always_inline]] inline std::size_t block_number(const MapView& view, double u, double w) noexcept {
    const std::size_t column = static_cast<std::uint32_t>(u) / MapBlock::side_cells;
    const std::size_t row = static_cast<std::uint32_t>(w) / MapBlock::side_cells;
    return row * view.block_columns + column;
}

/// The block around a place given in cells from the layer's lower corner, filled if nobody has asked for it before.
/// @pre view.contains(u, w)
[[nodiscard, gnu::always_inline]] inline const MapBlock& block_around(const MapView& view, double u, double w) {
    const std::size_t number = block_number(view, u, w);
    const MapBlock* const block = __atomic_load_n(view.blocks + number, __ATOMIC_ACQUIRE);
    if (block == nullptr) [[unlikely]] {
        return filled_block(view, number);
    }
    return *block;
}

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

/// The patch of a block around a place given in cells from the layer's lower corner.
/// @pre the block is the one around the place
[[nodiscard, gnu::always_inline]] inline MapPatch patch_in(const MapBlock& block, double u, double w) noexcept {
    // u - i is exact and less than 1, and so is its product with a power of two: no index can leave its cell.
    const auto i = static_cast<std::uint32_t>(u);
    const auto k = static_cast<std::uint32_t>(w);
    const std::uint32_t number = MapBlock::cell_at(i, k);
    const MapCell& cell = block.cells[number];
    const auto a = static_cast<std::uint32_t>((u - i) * cell.steps_x);
    const auto b = static_cast<std::uint32_t>((w - k) * cell.steps_z);
    const float* lower = block.nodes + cell.first_node + std::size_t{b} * (cell.steps_x + 1U) + a;
    const float* upper = lower + cell.steps_x + 1U;
    const double steps_x = cell.steps_x;
    const double steps_z = cell.steps_z;
    MapPatch patch{i + a / steps_x,  // exact, as all that follows from it
                   k + b / steps_z,         steps_x, steps_z, {lower[0], lower[1], upper[0], upper[1]}, {1, 1, 1, 1},
                   block.flyability[number]};
    if (block.sides[number] != CellSides::below) {
        const std::size_t behind = block.sides[number] == CellSides::both ? node_count(cell) : 0;
        lower += behind;
        upper += behind;
        patch.above[0] = lower[0];
        patch.above[1] = lower[1];
        patch.above[2] = upper[0];
        patch.above[3] = upper[1];
    }
    return patch;
}

/// The patch around a place given in cells from the layer's lower corner.
/// @pre view.contains(u, w)
[[nodiscard, gnu::always_inline]] inline MapPatch patch_at(const MapView& view, double u, double w) {
    return patch_in(block_around(view, u, w), u, w);
}

/// K at the share (s, t) of a patch, each in [0, 1). One template over the lane type.
template <class T>
T bilinear(const T corner[4], T s, T t) {
    const T low = corner[0] + s * (corner[1] - corner[0]);
    const T high = corner[2] + s * (corner[3] - corner[2]);
    return low + t * (high - low);
}

}  // namespace downwash
