#include "downwash/aeromap/volume_bricks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"

namespace downwash {
namespace {

constexpr double longest_radii = 0.45;  // of a cell's edge: no obstacle is missed

void require_range(double low_m, double high_m, const char* axis) {
    if (!(std::isfinite(low_m) && std::isfinite(high_m) && low_m < high_m)) {
        throw_input_error(std::string("the volume's ") + axis + " must be two finite numbers, the lower one first");
    }
}

VolumeGrid grid_over(const PlaneOfMotion& frame, const Bounds& extent, double lateral_low_m, double lateral_high_m,
                     double radius_m) {
    require_range(extent.x_low_m, extent.x_high_m, "x");
    require_range(lateral_low_m, lateral_high_m, "lateral");
    require_range(extent.z_low_m, extent.z_high_m, "z");
    VolumeGrid grid{frame,
                    {extent.x_low_m, lateral_low_m, extent.z_low_m},
                    {extent.x_high_m, lateral_high_m, extent.z_high_m},
                    {},
                    {},
                    {}};
    std::array<double, 3> cells{};
    double bricks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length_m = grid.high_m[axis] - grid.low_m[axis];
        cells[axis] = std::max(1.0, std::ceil(length_m / (longest_radii * radius_m)));
        grid.cell_m[axis] = length_m / cells[axis];
        bricks *= std::ceil(cells[axis] / VolumeBrick::side_cells);
    }
    if (!(bricks <= static_cast<double>(max_volume_bricks))) {
        throw_input_error("the volume has more than 2^22 bricks of 1.8 rotor radii; choose a smaller one");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.cells[axis] = static_cast<std::uint32_t>(cells[axis]);
        grid.bricks[axis] = (grid.cells[axis] + VolumeBrick::side_cells - 1) / VolumeBrick::side_cells;
    }
    return grid;
}

/// Nothing near anywhere: the flyable area's end is at least R away.
std::shared_ptr<const VolumeBrick> calm_brick(double radius_m) {
    auto brick = std::make_shared<OwnedBrick>();
    for (VolumeNode& cell : brick->cells) {
        cell.margin_m = static_cast<float>(radius_m);
    }
    brick->seal();
    return brick;
}

}  // namespace

SidedFactor<double> direct_value(const DirectEffect& effect, const Vector3& hub_m) {
    if (effect.is_of_walls_around()) {
        const Vector3 towards = effect.towards_wall(hub_m);
        return {towards[0], towards[1]};
    }
    return is_finite(hub_m) ? effect.sided_factor(hub_m) : SidedFactor<double>{1, 1};
}

VolumeBricks::VolumeBricks(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                           double lateral_low_m, double lateral_high_m)
    : effect_(std::move(effect)),
      grid_(grid_over(frame, extent, lateral_low_m, lateral_high_m, effect_->rotor_radius_m())),
      calm_(calm_brick(effect_->rotor_radius_m())),
      store_(grid_.brick_count()) {}

VolumeView VolumeBricks::view() noexcept {
    VolumeView view{};
    view.cos_heading = grid_.frame.cos_heading();
    view.sin_heading = grid_.frame.sin_heading();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.origin_m[axis] = grid_.frame.origin_m()[axis];
        view.low_m[axis] = grid_.low_m[axis];
        view.cells_per_m[axis] = grid_.cells[axis] / (grid_.high_m[axis] - grid_.low_m[axis]);
        view.cells[axis] = grid_.cells[axis];
    }
    view.bricks[0] = grid_.bricks[0];
    view.bricks[1] = grid_.bricks[1];
    view.calm_value = effect_->is_of_walls_around() ? 0 : 1;
    view.places = store_.slots();
    view.source = this;
    return view;
}

std::shared_ptr<const VolumeBrick> VolumeBricks::made(std::size_t number) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    std::shared_ptr<const VolumeBrick> brick = make_brick(*effect_, grid_, number);
    filling_ns_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
    return brick == nullptr ? calm_ : brick;
}

const VolumeBrick& VolumeBricks::filled(std::size_t number) {
    if (store_.is_in_the_making(number)) {
        look_ahead(number);
    }
    return store_.get(number, [this](std::size_t which) { return made(which); });
}

/// Fills a brick beside one, if there is any to fill.
void VolumeBricks::look_ahead(std::size_t number) {
    const auto at = grid_.brick_at(number);
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto is_filled_here = [this](std::size_t which) {
            return store_.try_make(which, [this](std::size_t one) { return made(one); });
        };
        if ((at[axis] + 1 < grid_.bricks[axis] && is_filled_here(number + stride)) ||
            (at[axis] > 0 && is_filled_here(number - stride))) {
            return;
        }
        stride *= grid_.bricks[axis];
    }
}

void VolumeBricks::fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over) {
    throw_if_over(is_over);
    std::vector<std::size_t> missing;
    for (std::size_t number = 0; number < store_.size(); ++number) {
        if (store_.find(number) == nullptr) {
            missing.push_back(number);
        }
    }
    run_parallel(
        missing.size(), threads,
        [&](std::size_t i) {
            throw_if_over(is_over);
            store_.get(missing[i], [this](std::size_t which) { return made(which); });
        },
        on_progress);
}

const VolumeBrick& filled_brick(const VolumeView& view, std::size_t number) {
    return view.source->filled(number);
}

SidedFactor<double> direct_value(const VolumeView& view, double x_m, double y_m, double z_m) {
    return direct_value(*view.source->effect(), {x_m, y_m, z_m});
}

}  // namespace downwash
