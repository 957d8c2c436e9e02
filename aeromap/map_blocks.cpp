#include "downwash/aeromap/map_blocks.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/aeromap/owned_block.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"

namespace downwash {
namespace {

bool is_range(double low, double high) {
    return std::isfinite(low) && std::isfinite(high) && low < high;
}

void require_valid(double grid_m, const Bounds& extent, const std::vector<MapLayer>& layers) {
    std::vector<KeyError> errors;
    if (!(std::isfinite(grid_m) && grid_m > 0)) {
        errors.push_back({"aero.grid_m", "must be a finite length above 0 in metres"});
    }
    if (!is_range(extent.x_low_m, extent.x_high_m)) {
        errors.push_back({"environment.bounds.x_m", "must be two finite numbers, the lower one first"});
    }
    if (!is_range(extent.z_low_m, extent.z_high_m)) {
        errors.push_back({"environment.bounds.z_m", "must be two finite numbers, the lower one first"});
    }
    for (const MapLayer& layer : layers) {
        if (!std::isfinite(layer.lateral_m)) {
            errors.push_back({"robot.rotors.positions_m", "must be finite numbers in metres"});
        }
    }
    throw_if_any(std::move(errors));
}

/// An extent that is a whole number of cells stays so in spite of rounding.
double cells_over(double low_m, double high_m, double cells_per_m) {
    return std::max(1.0, std::ceil((high_m - low_m) * cells_per_m - 1e-9));
}

double cell_side_m(const std::vector<MapLayer>& layers) {
    double side_m = std::numeric_limits<double>::infinity();
    for (const MapLayer& layer : layers) {
        side_m = std::min(side_m, longest_cell_side_m(*layer.effect));
    }
    const double grid_m = layers.front().effect->settings().grid_m;
    return grid_m / std::max(1.0, std::ceil(grid_m / side_m));
}

/// Adds the time from its making to its end to a sum.
class TimeSpent {
 public:
    explicit TimeSpent(std::atomic<std::int64_t>& sum_ns) : sum_ns_(sum_ns) {}
    ~TimeSpent() { sum_ns_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin_).count(); }
    TimeSpent(const TimeSpent&) = delete;
    TimeSpent& operator=(const TimeSpent&) = delete;

 private:
    using Clock = std::chrono::steady_clock;
    std::atomic<std::int64_t>& sum_ns_;
    Clock::time_point begin_ = Clock::now();
};

/// The blocks that cover some cells.
std::uint32_t blocks_over(std::uint32_t cells) {
    return (cells + MapBlock::side_cells - 1) / MapBlock::side_cells;
}

struct CellCounts {
    std::uint32_t columns, rows;
};

CellCounts counted_cells(const std::vector<MapLayer>& layers, const Bounds& extent, double cell_m) {
    const double columns = cells_over(extent.x_low_m, extent.x_high_m, 1 / cell_m);
    const double rows = cells_over(extent.z_low_m, extent.z_high_m, 1 / cell_m);
    if (!(columns * rows * static_cast<double>(layers.size()) <= max_map_cells)) {
        throw_input_error("gives a map of more than 2^24 cells over these bounds; choose a larger value",
                          "aero.grid_m");
    }
    return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
}

double checked_cell_m(const std::vector<MapLayer>& layers, const Bounds& extent) {
    assert(!layers.empty());
    require_valid(layers.front().effect->settings().grid_m, extent, layers);
    return cell_side_m(layers);
}

}  // namespace

double map_cells(const std::vector<MapLayer>& layers, const Bounds& extent) {
    const double cells_per_m = 1 / cell_side_m(layers);
    return cells_over(extent.x_low_m, extent.x_high_m, cells_per_m) *
           cells_over(extent.z_low_m, extent.z_high_m, cells_per_m) * static_cast<double>(layers.size());
}

MapBlocks::MapBlocks(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent)
    : layers_(std::move(layers)),
      plane_(plane),
      extent_(extent),
      cell_m_(checked_cell_m(layers_, extent_)),
      columns_(counted_cells(layers_, extent_, cell_m_).columns),
      rows_(counted_cells(layers_, extent_, cell_m_).rows),
      block_columns_(blocks_over(columns_)),
      block_rows_(blocks_over(rows_)),
      store_(blocks_per_layer() * layers_.size()) {}

MapView MapBlocks::view(std::size_t layer) noexcept {
    return {extent_.x_low_m,
            extent_.z_low_m,
            1 / cell_m_,
            columns_,
            rows_,
            block_columns_,
            store_.slots() + slot_of(layer, 0),
            this,
            layer};
}

/// Compares the flyability in a strip of two maps.
class MapBlocks::FlyabilityInTwo {
 public:
    /// @param strip number among those of all layers
    FlyabilityInTwo(const MapBlocks& now, const MapBlocks& before, std::size_t strip)
        : grids_{now.grid(strip / now.block_rows_, never_), before.grid(strip / now.block_rows_, never_)},
          now_(grids_[0], strip % now.block_rows_),
          before_(grids_[1], strip % now.block_rows_) {}

    [[nodiscard]] bool is_same(std::size_t column) {
        return now_.flyability_of(column) == before_.flyability_of(column);
    }

 private:
    StopCondition never_;
    std::array<LayerGrid, 2> grids_;
    StripBuilder now_, before_;
};

const MapBlock& filled_block(const MapView& view, std::size_t number) {
    return view.source->filled(view.source->slot_of(view.layer, number));
}

LayerGrid MapBlocks::grid(std::size_t layer, const StopCondition& is_over) const {
    return {*layers_[layer].effect,
            plane_,
            layers_[layer].lateral_m,
            extent_.x_low_m,
            extent_.z_low_m,
            cell_m_,
            columns_,
            rows_,
            is_over};
}

std::vector<std::size_t> MapBlocks::twins(std::size_t slot) const {
    const std::size_t block = slot % blocks_per_layer();
    std::vector<std::size_t> slots;
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        if (slot_of(layer, block) != slot) {
            slots.push_back(slot_of(layer, block));
        }
    }
    return slots;
}

std::size_t MapBlocks::first_of_equal(std::size_t slot) const {
    const MapBlock* const block = store_.find(slot);
    for (std::size_t earlier = slot % blocks_per_layer(); earlier < slot; earlier += blocks_per_layer()) {
        if (store_.find(earlier) == block) {
            return earlier;
        }
    }
    return slot;
}

std::shared_ptr<const MapBlock> MapBlocks::made(std::size_t slot) {
    const TimeSpent spent(filling_ns_);
    const StopCondition never;
    const LayerGrid layer = grid(slot / blocks_per_layer(), never);
    const std::size_t block = slot % blocks_per_layer();
    return StripBuilder(layer, block / block_columns_).block(block % block_columns_);
}

const MapBlock& MapBlocks::filled(std::size_t slot) {
    if (store_.is_in_the_making(slot)) {
        look_ahead(slot);
    }
    const std::vector<std::size_t> others = twins(slot);
    return store_.get(
        slot, [this](std::size_t number) { return made(number); }, others);
}

/// Fills one block near a slot: the same place in another layer, which other rotors ask for, or else a neighbour.
void MapBlocks::look_ahead(std::size_t slot) {
    const auto is_filled_here = [this](std::size_t number) {
        return store_.try_make(
            number, [this](std::size_t which) { return made(which); }, twins(number));
    };
    const std::vector<std::size_t> others = twins(slot);
    if (std::any_of(others.begin(), others.end(), is_filled_here)) {
        return;
    }
    const std::size_t block = slot % blocks_per_layer();
    const auto column = static_cast<std::int64_t>(block % block_columns_);
    const auto row = static_cast<std::int64_t>(block / block_columns_);
    constexpr std::array<std::array<int, 2>, 4> beside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const auto& [right, up] : beside) {
        const std::int64_t i = column + right;
        const std::int64_t k = row + up;
        if (i >= 0 && k >= 0 && i < block_columns_ && k < block_rows_ &&
            is_filled_here(slot - block + static_cast<std::size_t>(k) * block_columns_ + static_cast<std::size_t>(i))) {
            return;
        }
    }
}

void MapBlocks::take_over(const MapBlocks& before, const ColumnRange& changed) {
    const StopCondition never;
    for (std::size_t strip = 0; strip < layers_.size() * block_rows_; ++strip) {
        std::optional<FlyabilityInTwo> flyability;
        for (std::size_t column = 0; column < block_columns_; ++column) {
            const std::size_t slot = strip * block_columns_ + column;
            const std::size_t cells = column * MapBlock::side_cells;
            if (before.store_.find(slot) == nullptr || (cells >= changed.first && cells < changed.last)) {
                continue;
            }
            if (!flyability) {
                flyability.emplace(*this, before, strip);
            }
            if (flyability->is_same(column) && (column + 1 == block_columns_ || flyability->is_same(column + 1))) {
                put(slot, before.store_.share(slot));
            }
        }
    }
}

void MapBlocks::fill(std::span<const std::size_t> slots, int threads, const std::function<void(double)>& on_progress,
                     const StopCondition& is_over) {
    throw_if_over(is_over);
    // Blocks of one strip share what they look at.
    std::vector<std::vector<std::size_t>> strips(layers_.size() * block_rows_);
    for (const std::size_t slot : slots) {
        if (store_.find(slot) == nullptr) {
            strips[slot / block_columns_].push_back(slot);
        }
    }
    std::erase_if(strips, [](const auto& strip) { return strip.empty(); });
    run_parallel(
        strips.size(), threads,
        [&](std::size_t number) {
            const std::vector<std::size_t>& strip = strips[number];
            const LayerGrid layer = grid(strip.front() / blocks_per_layer(), is_over);
            StripBuilder builder(layer, strip.front() % blocks_per_layer() / block_columns_);
            if (8 * strip.size() >= block_columns_) {
                const TimeSpent spent(filling_ns_);
                builder.look_at_all();
            }
            for (const std::size_t slot : strip) {
                const auto make = [&](std::size_t which) {
                    const TimeSpent spent(filling_ns_);
                    return builder.block(which % block_columns_);
                };
                store_.get(slot, make, twins(slot));
            }
        },
        on_progress);
}

}  // namespace downwash
