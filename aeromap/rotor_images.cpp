#include "downwash/aeromap/rotor_images.hpp"

#include <algorithm>
#include <cstddef>

#include "downwash/aeromap/disc_average.hpp"

namespace downwash {
namespace {

/// K where the images take this share of a rotor's induced velocity, capped.
double factor_at(double loss, double max_factor) {
    return loss < 1 ? std::clamp(1 / (1 - loss), 1.0, max_factor) : max_factor;
}

}  // namespace

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

double RotorImages::loss(const DiscSide& on, const Vector3& hub_m) const {
    const double single = mean(on, hub_m, single_, integral_.get());
    if (single == 1) {
        return 0;  // nothing is below this disc, or above it
    }
    double loss = 1 - 1 / single;
    double own = 0;  // of the image that was looked at last
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
        const auto& [x_m, y_m, image] = neighbours_[i];
        if (i == 0 || image != neighbours_[i - 1].image) {
            own = mean(on, hub_m, images_[image]);
        }
        loss += std::min(own, mean(on, {hub_m[0] + x_m, hub_m[1] + y_m, hub_m[2]}, images_[image])) - 1;
    }
    return loss;
}

double RotorImages::factor(const DiscSide& on, const Vector3& hub_m) const {
    return factor_at(loss(on, hub_m), max_factor_);
}

double RotorImages::largest_change_beyond(double z_over_r) const {
    double loss = 1 - 1 / single_(z_over_r);
    for (const Neighbour& neighbour : neighbours_) {
        loss += images_[neighbour.image].largest_change_beyond(z_over_r);
    }
    return factor_at(loss, max_factor_) - 1;
}

}  // namespace downwash
