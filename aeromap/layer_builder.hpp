#pragma once

// Private to aeromap.

#include <cstddef>
#include <vector>

#include "downwash/aeromap/cell_refinement.hpp"
#include "downwash/aeromap/layer_grid.hpp"
#include "downwash/aeromap/map_view.hpp"

namespace downwash {

/// Some rows of cells, as they will stand in the layer.
struct CellRows {
    std::vector<CellSteps> steps;
    std::vector<CellFlyability> flyability;
    std::vector<CellSides> sides;
    /// K at the nodes of one cell after the other: of all surfaces, then of those above where both matter.
    std::vector<float> nodes;
};

/// A layer before a part of its scene changed.
struct LayerBefore {
    ColumnRange changed;               ///< columns in which K may differ
    const CellFlyability* flyability;  ///< flyability of the cells of the layer, row by row
};

/// Rows [first, last) of a layer. @throws WorkStopped when it is over before they are built
[[nodiscard]] CellRows build_rows(const LayerGrid& grid, std::size_t first, std::size_t last);

/// Builds a layer of which a part has changed: the values are those of the columns that are not as before.
/// @param[out] columns which these are
[[nodiscard]] CellRows rebuild_rows(const LayerGrid& grid, std::size_t first, std::size_t last,
                                    const LayerBefore& before, ColumnRange& columns);

/// The longest cell side for which max_steps resolve the steepest curve of the effect, at least R / 50; at most 0.45
/// R, so that the probes of a cell miss nothing of the disc's size.
[[nodiscard]] double longest_cell_side_m(const DirectEffect& effect);

/// Between positions that are this far apart K may rise and fall again unseen. Infinite for formulas that fall with
/// distance: they turn only from one obstacle to the next.
[[nodiscard]] double shortest_turn_m(const DirectEffect& effect);

}  // namespace downwash
