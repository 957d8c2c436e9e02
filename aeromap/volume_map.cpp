#include "downwash/aeromap/volume_map.hpp"

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "downwash/aeromap/volume_bricks.hpp"

namespace downwash {
namespace {

/// The same in bytes for each brick of the store: two pointers to it, what they share, and a flag.
constexpr std::size_t bytes_per_place = 3 * sizeof(void*) + 1;

struct Place {
    VolumeBox box;
    const VolumeBrick* brick;  ///< nullptr: outside the volume
};

Place place_at(const VolumeView& view, const Vector3& hub_m) {
    double u[3];
    count_cells(view, hub_m[0], hub_m[1], hub_m[2], u);
    if (!view.contains(u)) {
        return {{}, nullptr};
    }
    const VolumeBrick& brick = brick_around(view, u);
    return {box_around(brick, u), &brick};
}

}  // namespace

VolumeMap::VolumeMap(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                     double lateral_low_m, double lateral_high_m)
    : bricks_(std::make_shared<VolumeBricks>(std::move(effect), frame, extent, lateral_low_m, lateral_high_m)),
      view_(bricks_->view()) {}

double VolumeMap::factor(const Vector3& hub_m) const {
    const Place at = place_at(view_, hub_m);
    if (at.brick == nullptr || at.box.node.kind() == VolumeNodeKind::direct) {
        return direct_value(effect(), hub_m).all;
    }
    return at.box.node.kind() == VolumeNodeKind::calm
               ? view_.calm_value
               : value_at(at.brick->polynomials[at.box.node.index()], std::to_array(at.box.part));
}

SidedFactor<double> VolumeMap::sided_factor(const Vector3& hub_m) const {
    const Place at = place_at(view_, hub_m);
    if (at.brick == nullptr || at.box.node.kind() == VolumeNodeKind::direct) {
        return direct_value(effect(), hub_m);
    }
    const VolumeNode node = at.box.node;
    if (node.kind() == VolumeNodeKind::calm) {
        return {view_.calm_value, view_.calm_value};
    }
    const auto part = std::to_array(at.box.part);
    const Triquadratic* const polynomials = at.brick->polynomials + node.index();
    const double all = value_at(polynomials[0], part);
    return {all, node.kind() == VolumeNodeKind::below   ? 1
                 : node.kind() == VolumeNodeKind::above ? all
                                                        : value_at(polynomials[1], part)};
}

double VolumeMap::margin_m(const Vector3& hub_m) const {
    const Place at = place_at(view_, hub_m);
    if (at.brick == nullptr) {
        return 0;
    }
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double away_m = (at.box.part[axis] - 0.5) / (at.box.boxes_per_cell[axis] * view_.cells_per_m[axis]);
        squares += away_m * away_m;
    }
    return margin_at(double{at.box.node.margin_m}, std::sqrt(squares));
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
    return bricks_->store().size();
}

std::size_t VolumeMap::filled_bricks() const {
    return bricks_->store().made().size();
}

std::size_t VolumeMap::polynomials() const {
    std::size_t count = 0;
    for (const std::size_t number : bricks_->store().made()) {
        count += bricks_->store().find(number)->polynomials_size;
    }
    return count;
}

std::size_t VolumeMap::memory_bytes() const {
    const BlockStore<VolumeBrick>& store = bricks_->store();
    std::size_t bytes = sizeof(*this) + sizeof(VolumeBricks) + sizeof(OwnedBrick) + store.size() * bytes_per_place;
    for (const std::size_t number : store.made()) {
        const VolumeBrick* const brick = store.find(number);
        if (brick != bricks_->calm().get()) {
            bytes += sizeof(OwnedBrick) + brick->nodes_size * sizeof(VolumeNode) +
                     brick->polynomials_size * sizeof(Triquadratic);
        }
    }
    return bytes;
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
