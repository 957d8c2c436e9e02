#include "downwash/aeromap/rotor_images.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "downwash/aeromap/disc_average.hpp"
#include "downwash/effects/sided_factor.hpp"

namespace downwash {
RotorImages::RotorImages(double radius_m, double max_factor, const RotorNeighbours& neighbours)
    : radius_m_(radius_m),
      max_factor_(max_factor),
      single_(EffectModel::cheeseman_bennett, max_factor),
      integral_(std::make_shared<const CurveMean>(single_)) {
    for (std::size_t i = 0; i < neighbours.offsets_radii.size(); ++i) {
        if (i == 0 || neighbours.distances_radii[i] != neighbours.distances_radii[i - 1]) {
            images_.push_back(EffectCurve::image(neighbours.distances_radii[i], max_factor));
        }
        const auto& [x, y] = neighbours.offsets_radii[i];
        neighbours_.push_back({x * radius_m, y * radius_m, images_.size() - 1});
    }
}

double RotorImages::mean(const DiscSide& on, const Vector3& hub_m, const EffectCurve& curve,
                         const CurveMean* integral) const {
    return disc_average({on.scene, hub_m, radius_m_, on.side, curve, radius_m_, integral}, on.footprints);
}

template <class NeighbourHub>
double RotorImages::loss(const DiscSide& on, const Vector3& hub_m, const NeighbourHub& neighbour_m) const {
    const double single = mean(on, hub_m, single_, integral_.get());
    if (single == 1) {
        return 0;  // nothing is below this disc, or above it
    }
    double loss = 1 - 1 / single;
    double own = 0;  // of the image that was looked at last
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
        const std::size_t image = neighbours_[i].image;
        if (i == 0 || image != neighbours_[i - 1].image) {
            own = mean(on, hub_m, images_[image]);
        }
        loss += std::min(own, mean(on, neighbour_m(i), images_[image])) - 1;
    }
    return loss;
}

double RotorImages::factor(const DiscSide& on, const Vector3& hub_m) const {
    const auto level_m = [&](std::size_t i) {
        return Vector3{hub_m[0] + neighbours_[i].x_m, hub_m[1] + neighbours_[i].y_m, hub_m[2]};
    };
    return factor_with_loss(loss(on, hub_m, level_m), max_factor_);
}

double RotorImages::factor(const DiscSide& on, const Vector3& hub_m, std::span<const Vector3> neighbours_m) const {
    assert(neighbours_m.size() == neighbours_.size());
    return factor_with_loss(loss(on, hub_m, [&](std::size_t i) { return neighbours_m[i]; }), max_factor_);
}

double RotorImages::largest_change_beyond(double z_over_r) const {
    double loss = 1 - 1 / single_(z_over_r);
    for (const Neighbour& neighbour : neighbours_) {
        loss += images_[neighbour.image].largest_change_beyond(z_over_r);
    }
    return factor_with_loss(loss, max_factor_) - 1;
}

}  // namespace downwash
