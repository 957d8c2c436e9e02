#include "downwash/aeromap/volume_map.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "downwash/aeromap/volume_bricks.hpp"

namespace downwash {
namespace {

/// The box around a place; nothing outside the volume.
std::optional<VolumeBox> box_at(const VolumeView& view, const Vector3& hub_m) {
    double u[3];
    count_cells(view, hub_m[0], hub_m[1], hub_m[2], u);
    return view.contains(u) ? std::optional(box_around(view, u)) : std::nullopt;
}

}  // namespace

bool VolumeMap::fits(const Bounds& extent, double lateral_low_m, double lateral_high_m, double radius_m) {
    return has_few_bricks(extent, lateral_low_m, lateral_high_m, radius_m);
}

double VolumeMap::largest_m3(double radius_m) {
    const double edge_m = VolumeBrick::side_cells * longest_cell_radii * radius_m;
    return static_cast<double>(max_volume_bricks) * edge_m * edge_m * edge_m;
}

VolumeMap::VolumeMap(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                     double lateral_low_m, double lateral_high_m)
    : bricks_(std::make_shared<VolumeBricks>(std::move(effect), frame, extent, lateral_low_m, lateral_high_m)),
      view_(bricks_->view()) {}

double VolumeMap::factor(const Vector3& hub_m) const {
    const std::optional<VolumeBox> box = box_at(view_, hub_m);
    if (!box || box->kind == VolumeNodeKind::direct) {
        return direct_value(effect(), hub_m).all;
    }
    return box->kind == VolumeNodeKind::calm ? view_.calm_value
                                             : value_at(box->polynomials[0], std::to_array(box->part));
}

SidedFactor<double> VolumeMap::sided_factor(const Vector3& hub_m) const {
    const std::optional<VolumeBox> box = box_at(view_, hub_m);
    if (!box || box->kind == VolumeNodeKind::direct) {
        return direct_value(effect(), hub_m);
    }
    if (box->kind == VolumeNodeKind::calm) {
        return {view_.calm_value, view_.calm_value};
    }
    const auto part = std::to_array(box->part);
    const double all = value_at(box->polynomials[0], part);
    return {all, box->kind == VolumeNodeKind::below   ? 1
                 : box->kind == VolumeNodeKind::above ? all
                                                      : value_at(box->polynomials[1], part)};
}

double VolumeMap::margin_m(const Vector3& hub_m) const {
    const std::optional<VolumeBox> box = box_at(view_, hub_m);
    if (!box) {
        return 0;
    }
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double away_m = (box->part[axis] - 0.5) / (box->boxes_per_cell[axis] * view_.cells_per_m[axis]);
        squares += away_m * away_m;
    }
    return margin_at(double{box->margin_m}, std::sqrt(squares));
}

bool VolumeMap::is_flyable(const Vector3& hub_m) const {
    const double margin = margin_m(hub_m);
    return margin == 0 ? effect().is_flyable(hub_m) : margin > 0;
}

void VolumeMap::fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over) const {
    bricks_->fill(threads, on_progress, is_over);
}

const DirectEffect& VolumeMap::effect() const noexcept {
    return *bricks_->effect();
}

const PlaneOfMotion& VolumeMap::frame() const noexcept {
    return bricks_->grid().frame;
}

std::size_t VolumeMap::bricks() const noexcept {
    return bricks_->grid().brick_count();
}

std::size_t VolumeMap::filled_bricks() const {
    return bricks_->made().size();
}

std::size_t VolumeMap::polynomials() const {
    return bricks_->polynomials();
}

std::size_t VolumeMap::memory_bytes() const {
    return sizeof(*this) + bricks_->memory_bytes();
}

double VolumeMap::filling_s() const noexcept {
    return bricks_->filling_s();
}

VolumeMap VolumeMap::unfilled() const {
    const Vector3& low = low_m();
    const Vector3& high = high_m();
    return VolumeMap(bricks_->effect(), frame(), {low[0], high[0], low[2], high[2]}, low[1], high[1]);
}

const Vector3& VolumeMap::low_m() const noexcept {
    return bricks_->grid().low_m;
}

const Vector3& VolumeMap::high_m() const noexcept {
    return bricks_->grid().high_m;
}

}  // namespace downwash
