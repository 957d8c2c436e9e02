#pragma once

// Private to aeromap.

#include <array>
#include <cstddef>
#include <memory>

#include "downwash/aeromap/layer_grid.hpp"
#include "downwash/aeromap/map_view.hpp"

namespace downwash {

/// The flyability of the cells of a block, those beyond the end of the layer forbidden.
using BlockFlyability = std::array<CellFlyability, MapBlock::cell_count>;

/// Fills the blocks of one strip of a layer: a row of blocks. A block is a pure function of layer and number: of what
/// is over and under its own cells and those of the block to its right, whose parabolas answer for their common edge,
/// and of the flyability of both. Blocks that one builder fills share what was evaluated, which changes no value. For
/// one thread.
class StripBuilder {
 public:
    /// @param row number of the strip, from the lowest   @pre the grid outlives the builder
    StripBuilder(const LayerGrid& grid, std::size_t row);
    ~StripBuilder();
    StripBuilder(const StripBuilder&) = delete;
    StripBuilder& operator=(const StripBuilder&) = delete;

    /// Finds the flyability of all cells at once, which is sooner done than for most blocks one by one.
    void look_at_all();

    /// @param column number of the block in its strip   @throws WorkStopped when it is over before that is known
    [[nodiscard]] BlockFlyability flyability_of(std::size_t column);

    /// @param column number of the block in its strip   @throws WorkStopped when it is over before the block is filled
    [[nodiscard]] std::shared_ptr<const MapBlock> block(std::size_t column);

 private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// The longest cell side for which max_steps resolve the steepest curve of the effect, at least R / 50; at most 0.45
/// R, so that the probes of a cell miss nothing of the disc's size.
[[nodiscard]] double longest_cell_side_m(const DirectEffect& effect);

/// Between positions that are this far apart K may rise and fall again unseen. Infinite for formulas that fall with
/// distance: they turn only from one obstacle to the next.
[[nodiscard]] double shortest_turn_m(const DirectEffect& effect);

}  // namespace downwash
