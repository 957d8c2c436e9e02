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
    std::vector<LayerGrid> grids;
    for (const MapLayer& layer : layers_) {
        grids.push_back({*layer.effect, plane_, layer.lateral_m, extent_.x_low_m, extent_.z_low_m, cell_m_, columns_,
                         rows_, is_over});
    }
    const std::size_t tasks_per_layer = (rows_ + rows_per_task - 1) / rows_per_task;
    std::vector<CellRows> parts(tasks_per_layer * grids.size());
    run_parallel(
        parts.size(), threads,
        [&](std::size_t task) {
            const std::size_t first = (task % tasks_per_layer) * rows_per_task;
            parts[task] =
                build_rows(grids[task / tasks_per_layer], first, std::min<std::size_t>(first + rows_per_task, rows_));
        },
        on_progress);

    for (std::size_t layer = 0; layer < grids.size(); ++layer) {
        Raster raster;
        for (std::size_t task = layer * tasks_per_layer; task < (layer + 1) * tasks_per_layer; ++task) {
            raster.append(parts[task]);
            parts[task] = {};
        }
        raster.cells.shrink_to_fit();
        raster.flyability.shrink_to_fit();
        raster.sides.shrink_to_fit();
        raster.nodes.shrink_to_fit();
        add_raster(std::move(raster));
    }
}

void AeroMap::Raster::append(const CellRows& rows) {
    auto values = rows.nodes.begin();
    for (std::size_t i = 0; i < rows.steps.size(); ++i) {
        const CellSteps& steps = rows.steps[i];
        const std::ptrdiff_t kinds = rows.sides[i] == CellSides::both ? 2 : 1;
        const auto end = values + kinds * (steps.x + 1) * (steps.z + 1);
        const bool is_as_before =
            !cells.empty() && cells.back().steps_x == steps.x && cells.back().steps_z == steps.z &&
            (sides.back() == CellSides::both) == (kinds == 2) &&
            std::equal(values, end, nodes.begin() + static_cast<std::ptrdiff_t>(cells.back().first_node));
        const std::size_t first = is_as_before ? cells.back().first_node : nodes.size();
        if (first > std::numeric_limits<std::uint32_t>::max()) {
            throw_input_error("gives a map of more than 2^32 values; choose smaller bounds", "aero.grid_m");
        }
        cells.push_back({static_cast<std::uint32_t>(first), steps.x, steps.z});
        sides.push_back(rows.sides[i]);
        if (!is_as_before) {
            nodes.insert(nodes.end(), values, end);
        }
        values = end;
    }
    flyability.insert(flyability.end(), rows.flyability.begin(), rows.flyability.end());
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
