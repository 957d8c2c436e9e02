#include "downwash/aeromap/aero_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "downwash/aeromap/factor_patches.hpp"
#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"

namespace downwash {
namespace {

constexpr std::size_t rows_per_task = FactorPatches::block_cells;

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

/// Whether K depends on more than what is over and under the disc.
bool sees_beside(const std::vector<MapLayer>& layers) {
    return std::any_of(layers.begin(), layers.end(), [](const MapLayer& layer) {
        const DirectEffect& effect = *layer.effect;
        return effect.is_of_walls() || is_multirotor(effect.settings().ground.model) ||
               is_multirotor(effect.settings().ceiling.model) || effect.ground().depends_on_wall() ||
               effect.ceiling().depends_on_wall();
    });
}

}  // namespace

double map_cells(const std::vector<MapLayer>& layers, const Bounds& extent) {
    const double cells_per_m = 1 / cell_side_m(layers);
    return cells_over(extent.x_low_m, extent.x_high_m, cells_per_m) *
           cells_over(extent.z_low_m, extent.z_high_m, cells_per_m) * static_cast<double>(layers.size());
}

AeroMap::AeroMap(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent, int threads,
                 const std::function<void(double)>& on_progress, const StopCondition& is_over)
    : AeroMap(Empty(), std::move(layers), plane, extent) {
    build(threads, on_progress, is_over);
}

AeroMap::AeroMap(Empty /*tag*/, std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent)
    : layers_(std::move(layers)), plane_(plane), extent_(extent) {
    assert(!layers_.empty());
    require_valid(layers_.front().effect->settings().grid_m, extent_, layers_);
    cell_m_ = cell_side_m(layers_);
    cells_per_m_ = 1 / cell_m_;
    const double columns = cells_over(extent_.x_low_m, extent_.x_high_m, cells_per_m_);
    const double rows = cells_over(extent_.z_low_m, extent_.z_high_m, cells_per_m_);
    if (!(columns * rows * static_cast<double>(layers_.size()) <= max_map_cells)) {
        throw_input_error("gives a map of more than 2^24 cells over these bounds; choose a larger value",
                          "aero.grid_m");
    }
    columns_ = static_cast<std::uint32_t>(columns);
    rows_ = static_cast<std::uint32_t>(rows);
}

void AeroMap::build(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over) {
    build(threads, on_progress, is_over, nullptr, {0, columns_});
}

void AeroMap::build(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over,
                    const AeroMap* before, const ColumnRange& changed) {
    std::vector<LayerGrid> grids;
    for (const MapLayer& layer : layers_) {
        grids.push_back({*layer.effect, plane_, layer.lateral_m, extent_.x_low_m, extent_.z_low_m, cell_m_, columns_,
                         rows_, is_over});
    }
    const std::size_t tasks_per_layer = (rows_ + rows_per_task - 1) / rows_per_task;
    const auto rows_of = [&](std::size_t task) {
        const std::size_t first = (task % tasks_per_layer) * rows_per_task;
        return std::pair{first, std::min<std::size_t>(first + rows_per_task, rows_)};
    };
    std::vector<CellRows> parts(tasks_per_layer * grids.size());
    std::vector<ColumnRange> columns(parts.size(), ColumnRange{0, columns_});
    run_parallel(
        parts.size(), threads,
        [&](std::size_t task) {
            const std::size_t layer = task / tasks_per_layer;
            const auto [first, last] = rows_of(task);
            parts[task] = before == nullptr
                              ? build_rows(grids[layer], first, last)
                              : rebuild_rows(grids[layer], first, last,
                                             {changed, before->rasters_[layer]->flyability.data()}, columns[task]);
        },
        on_progress);

    for (std::size_t layer = 0; layer < grids.size(); ++layer) {
        Raster raster;
        for (std::size_t task = layer * tasks_per_layer; task < (layer + 1) * tasks_per_layer; ++task) {
            raster.append(parts[task], columns[task], before != nullptr ? before->rasters_[layer].get() : nullptr,
                          rows_of(task).first, columns_);
            parts[task] = {};
        }
        raster.cells.shrink_to_fit();
        raster.flyability.shrink_to_fit();
        raster.sides.shrink_to_fit();
        raster.nodes.shrink_to_fit();
        add_raster(std::move(raster));
    }
}

AeroMap AeroMap::rebuilt(std::vector<MapLayer> layers, const std::vector<BoundingBox>& changed, int threads,
                         const StopCondition& is_over) const {
    AeroMap next(Empty(), std::move(layers), plane_, extent_);
    const bool is_same_grid = next.cell_m_ == cell_m_ && next.columns_ == columns_ && next.rows_ == rows_ &&
                              layers_.size() == next.layers_.size();
    if (!is_same_grid || sees_beside(next.layers_)) {
        next.build(threads, {}, is_over);
    } else {
        next.build(threads, {}, is_over, this, next.columns_beside(changed));
    }
    return next;
}

bool AeroMap::is_touched(const std::vector<BoundingBox>& changed, const Bounds& part) const {
    const bool is_inside = part.x_low_m >= extent_.x_low_m && part.x_high_m <= extent_.x_high_m &&
                           part.z_low_m >= extent_.z_low_m && part.z_high_m <= extent_.z_high_m;
    if (!is_inside || (!changed.empty() && sees_beside(layers_))) {
        return true;
    }
    return std::any_of(changed.begin(), changed.end(), [&](const BoundingBox& box) {
        const ColumnRange columns = FactorPatches::changing_with(columns_beside({box}));
        return columns.first < columns.last &&
               extent_.x_low_m + static_cast<double>(columns.first) * cell_m_ <= part.x_high_m &&
               extent_.x_low_m + static_cast<double>(columns.last) * cell_m_ >= part.x_low_m;
    });
}

/// The columns whose discs are over or under some boxes, or so near them that it matters for what is flyable; none
/// without a box.
ColumnRange AeroMap::columns_beside(const std::vector<BoundingBox>& boxes) const {
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -low_m;
    for (const BoundingBox& box : boxes) {
        for (const double x_m : {box.low_m[0], box.high_m[0]}) {
            for (const double y_m : {box.low_m[1], box.high_m[1]}) {
                const double along_m = plane_.from_world({x_m, y_m, 0})[0];
                low_m = std::min(low_m, along_m);
                high_m = std::max(high_m, along_m);
            }
        }
    }
    double reach_m = cell_m_;
    for (const MapLayer& layer : layers_) {
        reach_m = std::max(reach_m,
                           cell_m_ + layer.effect->column_radius_m() + std::max(0.0, layer.effect->min_clearance_m()));
    }
    const auto column_at = [this](double x_m) {
        return static_cast<std::size_t>(
            std::clamp((x_m - extent_.x_low_m) * cells_per_m_, 0.0, static_cast<double>(columns_)));
    };
    return low_m > high_m ? ColumnRange{columns_, 0}
                          : ColumnRange{column_at(low_m - reach_m), column_at(high_m + reach_m)};
}

/// Rows of which only some columns were built; the others are those of another raster.
void AeroMap::Raster::append(const CellRows& rows, const ColumnRange& columns, const Raster* before, std::size_t first,
                             std::size_t width) {
    const float* values = rows.nodes.data();
    std::size_t built = 0;
    const std::size_t height = rows.flyability.size() / width;
    for (std::size_t k = 0; k < height; ++k) {
        for (std::size_t i = 0; i < width; ++i) {
            if (i >= columns.first && i < columns.last) {
                append_cell(rows.steps[built].x, rows.steps[built].z, rows.sides[built], values);
                values += value_count(cells.back(), sides.back());
                ++built;
            } else {
                const std::size_t cell = (first + k) * width + i;
                const MapCell& same = before->cells[cell];
                append_cell(same.steps_x, same.steps_z, before->sides[cell], before->nodes.data() + same.first_node);
            }
        }
    }
    flyability.insert(flyability.end(), rows.flyability.begin(), rows.flyability.end());
}

/// Values of all kinds that a cell has.
std::ptrdiff_t AeroMap::Raster::value_count(const MapCell& cell, CellSides sides) {
    return static_cast<std::ptrdiff_t>((sides == CellSides::both ? 2 : 1) * node_count(cell));
}

void AeroMap::Raster::append_cell(std::uint16_t steps_x, std::uint16_t steps_z, CellSides side, const float* values) {
    MapCell cell{0, steps_x, steps_z};
    const std::ptrdiff_t count = value_count(cell, side);
    const bool is_as_before =
        !cells.empty() && cells.back().steps_x == steps_x && cells.back().steps_z == steps_z &&
        (sides.back() == CellSides::both) == (side == CellSides::both) &&
        std::equal(values, values + count, nodes.begin() + static_cast<std::ptrdiff_t>(cells.back().first_node));
    const std::size_t first = is_as_before ? cells.back().first_node : nodes.size();
    if (first > std::numeric_limits<std::uint32_t>::max()) {
        throw_input_error("gives a map of more than 2^32 values; choose smaller bounds", "aero.grid_m");
    }
    cell.first_node = static_cast<std::uint32_t>(first);
    cells.push_back(cell);
    sides.push_back(side);
    if (!is_as_before) {
        nodes.insert(nodes.end(), values, values + count);
    }
}

void AeroMap::add_raster(Raster raster) {
    const auto is_same = [&raster](const std::shared_ptr<const Raster>& other) {
        const auto bytes_agree = [](const auto& a, const auto& b) {
            return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
        };
        return bytes_agree(raster.cells, other->cells) && bytes_agree(raster.flyability, other->flyability) &&
               bytes_agree(raster.sides, other->sides) && bytes_agree(raster.nodes, other->nodes);
    };
    const auto known = std::find_if(rasters_.begin(), rasters_.end(), is_same);
    rasters_.push_back(known != rasters_.end() ? *known : std::make_shared<const Raster>(std::move(raster)));
}

std::size_t AeroMap::memory_bytes() const noexcept {
    std::size_t bytes = sizeof(*this);
    for (std::size_t layer = 0; layer < rasters_.size(); ++layer) {
        const std::shared_ptr<const Raster>& raster = rasters_[layer];
        if (std::find(rasters_.begin(), rasters_.begin() + static_cast<std::ptrdiff_t>(layer), raster) ==
            rasters_.begin() + static_cast<std::ptrdiff_t>(layer)) {
            bytes += raster->cells.capacity() * sizeof(MapCell) + raster->flyability.capacity() +
                     raster->sides.capacity() + raster->nodes.capacity() * sizeof(float);
        }
    }
    return bytes;
}

SidedFactor<double> AeroMap::sided_factor_outside(std::size_t layer, double x_m, double z_m) const noexcept {
    if (!(std::isfinite(x_m) && std::isfinite(z_m))) {
        return {1, 1};
    }
    return layers_[layer].effect->sided_factor(plane_.to_world(x_m, layers_[layer].lateral_m, z_m));
}

SidedFactor<double> AeroMap::sided_factor(std::size_t layer, double x_m, double z_m) const noexcept {
    const double u = (x_m - extent_.x_low_m) * cells_per_m_;
    const double w = (z_m - extent_.z_low_m) * cells_per_m_;
    const MapView map = view(layer);
    if (!map.contains(u, w)) {
        return sided_factor_outside(layer, x_m, z_m);
    }
    const MapPatch patch = patch_at(map, u, w);
    const double s = (u - patch.u) * patch.steps_x;
    const double t = (w - patch.w) * patch.steps_z;
    return {bilinear(patch.corner, s, t), bilinear(patch.above, s, t)};
}

bool AeroMap::is_flyable(std::size_t layer, double x_m, double z_m) const {
    const double u = (x_m - extent_.x_low_m) * cells_per_m_;
    const double w = (z_m - extent_.z_low_m) * cells_per_m_;
    if (u >= 0 && w >= 0 && u < columns_ && w < rows_) {
        const std::size_t cell = static_cast<std::size_t>(w) * columns_ + static_cast<std::size_t>(u);
        const CellFlyability flyability = rasters_[layer]->flyability[cell];
        if (flyability != CellFlyability::mixed) {
            return flyability == CellFlyability::flyable;
        }
    }
    return layers_[layer].effect->is_flyable(plane_.to_world(x_m, layers_[layer].lateral_m, z_m));
}

}  // namespace downwash
