#include "downwash/aeromap/aero_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "downwash/aeromap/factor_patches.hpp"
#include "downwash/aeromap/map_blocks.hpp"
#include "downwash/aeromap/owned_block.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash {
namespace {

/// Whether K depends on more than what is over and under the disc.
bool sees_beside(const std::vector<MapLayer>& layers) {
    return std::any_of(layers.begin(), layers.end(), [](const MapLayer& layer) {
        const DirectEffect& effect = *layer.effect;
        return effect.is_of_walls() || is_multirotor(effect.settings().ground.model) ||
               is_multirotor(effect.settings().ceiling.model) || effect.ground().depends_on_wall() ||
               effect.ceiling().depends_on_wall();
    });
}

/// Of the store: two pointers to the block, what they share, and a flag.
constexpr std::size_t bytes_per_slot = 3 * sizeof(void*) + 1;

}  // namespace

AeroMap::AeroMap(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent)
    : blocks_(std::make_shared<MapBlocks>(std::move(layers), plane, extent)) {
    for (std::size_t layer = 0; layer < blocks_->layers().size(); ++layer) {
        views_.push_back(blocks_->view(layer));
    }
}

void AeroMap::fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over) const {
    std::vector<std::size_t> slots(blocks_->store().size());
    std::iota(slots.begin(), slots.end(), std::size_t{0});
    blocks_->fill(slots, threads, on_progress, is_over);
}

void AeroMap::fill_around(std::span<const LayerPlace> places, int threads,
                          const std::function<void(double)>& on_progress, const StopCondition& is_over) const {
    std::vector<std::size_t> slots;
    for (const auto& [layer, x_m, z_m] : places) {
        const MapView& map = views_[layer];
        const double u = (x_m - map.x_low_m) * map.cells_per_m;
        const double w = (z_m - map.z_low_m) * map.cells_per_m;
        if (map.contains(u, w)) {
            slots.push_back(blocks_->slot_of(layer, block_number(map, u, w)));
        }
    }
    blocks_->fill(slots, threads, on_progress, is_over);
}

double AeroMap::filled_share() const {
    return static_cast<double>(blocks_->store().made().size()) / static_cast<double>(blocks_->store().size());
}

double AeroMap::filling_s() const noexcept {
    return blocks_->filling_s();
}

const Bounds& AeroMap::extent() const noexcept {
    return blocks_->extent();
}

const PlaneOfMotion& AeroMap::plane() const noexcept {
    return blocks_->plane();
}

const std::vector<MapLayer>& AeroMap::layers() const noexcept {
    return blocks_->layers();
}

AeroMap AeroMap::rebuilt(std::vector<MapLayer> layers, const std::vector<BoundingBox>& changed) const {
    AeroMap next(std::move(layers), plane(), extent());
    const MapBlocks& before = *blocks_;
    MapBlocks& after = *next.blocks_;
    const bool is_same_grid = after.cell_m() == before.cell_m() && after.columns() == before.columns() &&
                              after.rows() == before.rows() && before.layers().size() == after.layers().size();
    if (!is_same_grid || sees_beside(after.layers())) {
        return next;
    }
    after.take_over(before, FactorPatches::changing_with(next.columns_beside(changed)));
    return next;
}

bool AeroMap::is_touched(const std::vector<BoundingBox>& changed, const Bounds& part) const {
    const Bounds& whole = extent();
    const bool is_inside = part.x_low_m >= whole.x_low_m && part.x_high_m <= whole.x_high_m &&
                           part.z_low_m >= whole.z_low_m && part.z_high_m <= whole.z_high_m;
    if (!is_inside || (!changed.empty() && sees_beside(layers()))) {
        return true;
    }
    const double cell_m = blocks_->cell_m();
    return std::any_of(changed.begin(), changed.end(), [&](const BoundingBox& box) {
        const ColumnRange columns = FactorPatches::changing_with(columns_beside({box}));
        return columns.first < columns.last &&
               whole.x_low_m + static_cast<double>(columns.first) * cell_m <= part.x_high_m &&
               whole.x_low_m + static_cast<double>(columns.last) * cell_m >= part.x_low_m;
    });
}

/// The columns whose discs are over or under some boxes, or so near them that it matters where in a cell one may fly;
/// none without a box.
ColumnRange AeroMap::columns_beside(const std::vector<BoundingBox>& boxes) const {
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -low_m;
    for (const BoundingBox& box : boxes) {
        for (const double x_m : {box.low_m[0], box.high_m[0]}) {
            for (const double y_m : {box.low_m[1], box.high_m[1]}) {
                const double along_m = plane().from_world({x_m, y_m, 0})[0];
                low_m = std::min(low_m, along_m);
                high_m = std::max(high_m, along_m);
            }
        }
    }
    const double near_m = 2 * blocks_->cell_m();  // one of them for the last column, which may be reached into
    double reach_m = near_m;
    for (const MapLayer& layer : layers()) {
        reach_m = std::max(reach_m,
                           near_m + layer.effect->column_radius_m() + std::max(0.0, layer.effect->min_clearance_m()));
    }
    // Parabolas of the last block reach beyond the last column.
    const std::size_t count = std::size_t{blocks_->block_columns()} * MapBlock::side_cells;
    const auto column_at = [&](double x_m) {
        return static_cast<std::size_t>(
            std::clamp((x_m - extent().x_low_m) / blocks_->cell_m(), 0.0, static_cast<double>(count)));
    };
    return low_m > high_m ? ColumnRange{count, 0}
                          : ColumnRange{column_at(low_m - reach_m), column_at(high_m + reach_m)};
}

std::size_t AeroMap::memory_bytes() const {
    const BlockStore<MapBlock>& store = blocks_->store();
    std::size_t bytes = sizeof(*this) + sizeof(MapBlocks) + store.size() * bytes_per_slot;
    for (const std::size_t slot : store.made()) {
        if (blocks_->first_of_equal(slot) == slot) {
            bytes += sizeof(OwnedBlock) + store.find(slot)->nodes_size * sizeof(float);
        }
    }
    return bytes;
}

SidedFactor<double> AeroMap::sided_factor_outside(std::size_t layer, double x_m, double z_m) const {
    if (!(std::isfinite(x_m) && std::isfinite(z_m))) {
        return {1, 1};
    }
    return layers()[layer].effect->sided_factor(plane().to_world(x_m, layers()[layer].lateral_m, z_m));
}

SidedFactor<double> AeroMap::sided_factor(std::size_t layer, double x_m, double z_m) const {
    const MapView& map = views_[layer];
    const double u = (x_m - map.x_low_m) * map.cells_per_m;
    const double w = (z_m - map.z_low_m) * map.cells_per_m;
    if (!map.contains(u, w)) {
        return sided_factor_outside(layer, x_m, z_m);
    }
    const MapPatch patch = patch_at(map, u, w);
    const double s = (u - patch.u) * patch.steps_x;
    const double t = (w - patch.w) * patch.steps_z;
    return {bilinear(patch.corner, s, t), bilinear(patch.above, s, t)};
}

bool AeroMap::is_flyable(std::size_t layer, double x_m, double z_m) const {
    const MapView& map = views_[layer];
    const double u = (x_m - map.x_low_m) * map.cells_per_m;
    const double w = (z_m - map.z_low_m) * map.cells_per_m;
    if (map.contains(u, w)) {
        const std::uint32_t cell = MapBlock::cell_at(static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(w));
        const CellFlyability flyability = block_around(map, u, w).flyability[cell];
        if (flyability != CellFlyability::mixed) {
            return flyability == CellFlyability::flyable;
        }
    }
    return layers()[layer].effect->is_flyable(plane().to_world(x_m, layers()[layer].lateral_m, z_m));
}

MapArrays arrays_of(const AeroMap& map, std::size_t layer, int threads) {
    map.fill(threads);
    const MapView& view = map.view(layer);
    MapArrays arrays{view.columns, view.rows, {}, {}, {}, {}};
    for (std::uint32_t k = 0; k < view.rows; ++k) {
        for (std::uint32_t i = 0; i < view.columns; ++i) {
            const MapBlock& block = block_around(view, i, k);
            const std::uint32_t number = MapBlock::cell_at(i, k);
            const MapCell& cell = block.cells[number];
            const float* const values = block.nodes + cell.first_node;
            const std::size_t count = (block.sides[number] == CellSides::both ? 2 : 1) * node_count(cell);
            const bool is_as_before =
                !arrays.cells.empty() && arrays.cells.back().steps_x == cell.steps_x &&
                arrays.cells.back().steps_z == cell.steps_z &&
                arrays.nodes.size() - arrays.cells.back().first_node == count &&
                std::equal(values, values + count, arrays.nodes.end() - static_cast<std::ptrdiff_t>(count));
            const std::size_t first = is_as_before ? arrays.cells.back().first_node : arrays.nodes.size();
            if (first > std::numeric_limits<std::uint32_t>::max()) {
                throw_input_error("gives a map of more than 2^32 values; choose smaller bounds", "aero.grid_m");
            }
            arrays.cells.push_back({static_cast<std::uint32_t>(first), cell.steps_x, cell.steps_z});
            arrays.flyability.push_back(block.flyability[number]);
            arrays.sides.push_back(block.sides[number]);
            if (!is_as_before) {
                arrays.nodes.insert(arrays.nodes.end(), values, values + count);
            }
        }
    }
    return arrays;
}

}  // namespace downwash
