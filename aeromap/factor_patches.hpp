#pragma once

// Private to aeromap.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "downwash/aeromap/cell_refinement.hpp"
#include "downwash/aeromap/known_factors.hpp"
#include "downwash/aeromap/layer_grid.hpp"
#include "downwash/aeromap/map_view.hpp"

namespace downwash {

/// K over a strip of a layer for far fewer evaluations than it is asked for. Square blocks of cells are halved until
/// parabolas through samples meet K at further samples, or are left to direct evaluation when they do not; what was
/// evaluated once is remembered. Squares are fitted where and when K is asked for, each without regard to the others:
/// what one knows of a square does not depend on what was asked before.
class FactorPatches {
 public:
    /// The largest squares, and the strip, are as many cells wide and high. Where their lower left corners are flyable
    /// K is exact there.
    static constexpr std::size_t block_cells = MapBlock::side_cells;

    /// Which columns of a layer change with some of them: their whole blocks, and the block before them, whose right
    /// edge is theirs. None without any.
    [[nodiscard]] static ColumnRange changing_with(const ColumnRange& columns) {
        if (columns.first >= columns.last) {
            return {0, 0};
        }
        const std::size_t first = columns.first / block_cells;
        return {(first - std::min<std::size_t>(first, 1)) * block_cells,
                (columns.last + block_cells - 1) / block_cells * block_cells};
    }

    /// Whether the cells [i, i + n) of the layer's rows [k, k + n) are flyable throughout; of those in the layer.
    enum class Flyable : std::uint8_t { none, some, all };
    using FlyableCells = std::function<Flyable(std::size_t i, std::size_t k, std::size_t n)>;

    /// @param first the strip's first row
    /// @param flyable where parabolas may be fitted: where all cells are flyable. Empty: K is evaluated directly
    /// everywhere, as it must be where it does not turn only from one obstacle to the next (shortest_turn_m)
    FactorPatches(const LayerGrid& grid, std::size_t first, FlyableCells flyable);

    /// K at a point of the strip, which is taken to the nearest of 2048 in a cell's side; parabolas miss by about
    /// 0.002 at most.
    [[nodiscard]] SidedFactor<double> factor(double x_m, double z_m);

 private:
    /// K at nine samples, x running fastest.
    using Values = std::array<SidedFactor<double>, 9>;
    /// In the lattice of 2048 points to a cell's side, from the strip's lower left corner.
    struct Square {
        std::uint64_t x, z, side;
    };

    void fit(std::size_t node, const Square& square);
    [[nodiscard]] bool is_met(const Square& square, const Values& values);
    [[nodiscard]] bool is_quiet(const Square& square) const;
    [[nodiscard]] SidedFactor<double> sample(std::uint64_t x, std::uint64_t z);
    [[nodiscard]] Vector3 hub_m(std::uint64_t x, std::uint64_t z) const;

    const LayerGrid& grid_;
    std::size_t first_;
    FlyableCells flyable_;
    /// Nodes of the blocks and, behind them, of their quarters in groups of four: what a node stands for is unknown,
    /// `direct`, the index of its first quarter, or -1 - i for values_[i].
    std::vector<std::int32_t> nodes_;
    std::size_t blocks_ = 0;
    std::vector<Values> values_;
    /// K at points of the lattice; forgotten when they grow many.
    KnownFactors known_;
};

}  // namespace downwash
