#include "downwash/aeromap/factor_patches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/triquadratic.hpp"

namespace downwash {
namespace {

/// The greatest error of the parabolas at the points looked at.
constexpr double allowed_difference = 0.002;

/// The finest division of a cell has 512 steps, and its probes look at their quarters.
constexpr std::uint64_t cell_units = 4 * max_steps;
constexpr std::uint64_t block_units = cell_units * FactorPatches::block_cells;
constexpr std::uint64_t min_units = cell_units / 2;

/// A few megabytes; some ten thousand are usual.
constexpr std::size_t max_known = 1U << 17U;

/// A node without parabolas. Block 0 is no quarter.
constexpr std::int32_t direct = 0;
/// A node that nobody has asked for, and one in a square that is flyable as a whole.
constexpr std::int32_t unknown = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t unknown_flyable = unknown + 1;

/// The product of two parabolas through 3 x 3 values, at parts from 0 to 1 of the square's side.
SidedFactor<double> biquadratic(const std::array<SidedFactor<double>, 9>& values, double x, double z) {
    const auto along_x = parabola_weights(x);
    const auto along_z = parabola_weights(z);
    SidedFactor<double> sum{0, 0};
    for (std::size_t row = 0; row < 3; ++row) {
        const SidedFactor<double>* const v = &values[3 * row];
        sum.all += along_z[row] * (along_x[0] * v[0].all + along_x[1] * v[1].all + along_x[2] * v[2].all);
        sum.above += along_z[row] * (along_x[0] * v[0].above + along_x[1] * v[1].above + along_x[2] * v[2].above);
    }
    return sum;
}

}  // namespace

FactorPatches::FactorPatches(const LayerGrid& grid, std::size_t first, FlyableCells flyable)
    : grid_(grid),
      first_(first),
      flyable_(std::move(flyable)),
      blocks_(flyable_ ? (grid.columns + block_cells - 1) / block_cells : 0) {
    nodes_.assign(blocks_, unknown);
}

/// Decides what a node stands for.
void FactorPatches::fit(std::size_t node, const Square& square) {
    const Flyable flyable = nodes_[node] == unknown_flyable
                                ? Flyable::all
                                : flyable_(square.x / cell_units, first_ + square.z / cell_units,
                                           std::max(square.side / cell_units, std::uint64_t{1}));
    nodes_[node] = direct;
    if (flyable == Flyable::none || (flyable == Flyable::some && square.side <= cell_units)) {
        return;
    }
    if (flyable == Flyable::all) {
        Values values{};
        for (std::size_t n = 0; n < values.size(); ++n) {
            values[n] = sample(square.x + n % 3 * (square.side / 2), square.z + n / 3 * (square.side / 2));
        }
        if (is_quiet(square) || is_met(square, values)) {
            values_.push_back(values);
            nodes_[node] = -static_cast<std::int32_t>(values_.size());
            return;
        }
    }
    if (square.side > min_units) {
        nodes_[node] = static_cast<std::int32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 4, flyable == Flyable::all ? unknown_flyable : unknown);
    }
}

/// Looks at the middles of the quarters: farthest from all samples, and close to where a parabola misses most.
bool FactorPatches::is_met(const Square& square, const Values& values) {
    const auto is_close = [&](unsigned x, unsigned z) {
        const SidedFactor<double> there = sample(square.x + x * (square.side / 4), square.z + z * (square.side / 4));
        const SidedFactor<double> met = biquadratic(values, 0.25 * x, 0.25 * z);
        return std::abs(there.all - met.all) <= allowed_difference &&
               std::abs(there.above - met.above) <= allowed_difference;
    };
    return is_close(1, 1) && is_close(3, 3) && is_close(3, 1) && is_close(1, 3);
}

bool FactorPatches::is_quiet(const Square& square) const {
    return downwash::is_quiet(
        grid_.effect,
        max_change(grid_.effect, BoundingBox::around(hub_m(square.x, square.z),
                                                     hub_m(square.x + square.side, square.z + square.side))));
}

SidedFactor<double> FactorPatches::factor(double x_m, double z_m) {
    const double units_per_m = cell_units / grid_.side_m;
    const double z_low_m = grid_.z_low_m + static_cast<double>(first_) * grid_.side_m;
    const auto x = static_cast<std::uint64_t>(std::llround((x_m - grid_.x_low_m) * units_per_m));
    const auto z = static_cast<std::uint64_t>(std::llround((z_m - z_low_m) * units_per_m));
    // The last of a row of blocks has the border to its right.
    const std::size_t block = x == blocks_ * block_units ? blocks_ - 1 : x / block_units;
    if (!(block < blocks_ && z <= block_units)) {
        return sample(x, z);
    }
    Square square{block * block_units, 0, block_units};
    const auto stands_for = [&](std::size_t place) {
        if (nodes_[place] <= unknown_flyable) {
            fit(place, square);
        }
        return nodes_[place];
    };
    std::int32_t node = stands_for(block);
    while (node > direct) {
        square.side /= 2;
        const bool is_right = x >= square.x + square.side;
        const bool is_upper = z >= square.z + square.side;
        square.x += is_right ? square.side : 0;
        square.z += is_upper ? square.side : 0;
        node = stands_for(static_cast<std::size_t>(node) + (is_right ? 1U : 0U) + (is_upper ? 2U : 0U));
    }
    if (node == direct) {
        return sample(x, z);
    }
    const auto part = [&square](std::uint64_t units) {
        return static_cast<double>(units) / static_cast<double>(square.side);
    };
    return biquadratic(values_[static_cast<std::size_t>(-1 - node)], part(x - square.x), part(z - square.z));
}

SidedFactor<double> FactorPatches::sample(std::uint64_t x, std::uint64_t z) {
    throw_if_over(grid_.is_over);
    if (known_.size() >= max_known) {
        known_.clear();
    }
    return known_.find_or_add(x * (2 * block_units) + z, [&] { return grid_.effect.sided_factor(hub_m(x, z)); });
}

/// At corners of cells as exactly there as the map's own arithmetic has them.
Vector3 FactorPatches::hub_m(std::uint64_t x, std::uint64_t z) const {
    const double columns = static_cast<double>(x) / cell_units;
    const double rows = static_cast<double>(first_) + static_cast<double>(z) / cell_units;
    return grid_.plane.to_world(grid_.x_low_m + columns * grid_.side_m, grid_.lateral_m,
                                grid_.z_low_m + rows * grid_.side_m);
}

}  // namespace downwash
