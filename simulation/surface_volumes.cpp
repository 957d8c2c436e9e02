#include "downwash/simulation/surface_volumes.hpp"

#include <algorithm>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/simulation/space_rotor_places.hpp"

namespace downwash {
namespace {

/// A rotor alone: its own image is that of a single rotor.
SurfaceEffect on_single_rotor(const SurfaceEffect& effect) {
    return is_multirotor(effect.model) ? SurfaceEffect(EffectModel::cheeseman_bennett) : effect;
}

template <class Volumes, class Do>
void for_each_volume(Volumes& volumes, const Do& act) {
    for (const auto& map : {volumes.rotor, volumes.fountain, volumes.walls}) {
        if (map != nullptr) {
            act(*map);
        }
    }
    for (const auto& image : volumes.images) {
        act(*image.map);
    }
}

}  // namespace

SurfaceVolumes::SurfaceVolumes(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero,
                               const SpaceRobot& robot, const PlaneOfMotion& frame, const Bounds& extent,
                               double lateral_low_m, double lateral_high_m)
    : has_ground_images(aero.enabled && !aero.map && is_multirotor(aero.ground.model)),
      has_ceiling_images(aero.enabled && !aero.map && is_multirotor(aero.ceiling.model)) {
    const simulation::SpaceRotorPlaces places(robot);
    const double radius_m = robot.rotor_radius_m;
    const auto volume_of = [&](DirectEffect effect) {
        return std::make_shared<VolumeMap>(std::make_shared<const DirectEffect>(std::move(effect)), frame, extent,
                                           lateral_low_m, lateral_high_m);
    };
    AeroSettings alone = aero;
    alone.ground = on_single_rotor(aero.ground);
    alone.ceiling = on_single_rotor(aero.ceiling);
    rotor = volume_of(DirectEffect(scene, alone, radius_m));
    if (has_ground_images || has_ceiling_images) {
        for (std::size_t i = 0; i < places.hubs_m.size(); ++i) {
            for (const double distance_radii : places.neighbours(i).distances_radii) {
                if (std::none_of(images.begin(), images.end(),
                                 [&](const Image& image) { return image.distance_radii == distance_radii; })) {
                    images.push_back(
                        {distance_radii, volume_of(DirectEffect::image(scene, aero, radius_m, distance_radii))});
                }
            }
        }
    }
    if (has_ground_images && aero.ground.model == EffectModel::multirotor_body) {
        fountain = volume_of(DirectEffect::fountain_on_disc(scene, aero, radius_m, places.neighbours(0)));
    }
    if (aero.enabled && aero.wall.is_any()) {
        walls = volume_of(DirectEffect::walls_around(scene, aero, radius_m, places.reach_m));
    }
}

void SurfaceVolumes::read(const std::filesystem::path& folder) {
    if (!folder.empty()) {
        for_each_volume(*this, [&](VolumeMap& map) { MapCache(folder).read(map); });
    }
}

void SurfaceVolumes::keep(const std::filesystem::path& folder) const {
    if (!folder.empty()) {
        for_each_volume(*this, [&](const VolumeMap& map) { MapCache(folder).keep(map); });
    }
}

namespace simulation {

VolumeSpaceEffect::VolumeSpaceEffect(const SurfaceVolumes& volumes, const SpaceRobot& robot)
    : volumes_(volumes),
      rotors_(std::make_unique<const SpaceRotorPlaces>(robot)),
      max_factor_(volumes.rotor->effect().settings().max_factor),
      patches_(rotors_->hubs_m.size(), VolumePatches<double>(volumes.rotor->view())) {
    if (volumes_.walls != nullptr) {
        walls_.emplace_back(volumes_.walls->view());
    }
    for (std::size_t i = 0; i < rotors_->hubs_m.size() && !volumes_.images.empty(); ++i) {
        std::vector<const VolumeMap*> of_neighbours;
        for (const double distance_radii : rotors_->neighbours(i).distances_radii) {
            const auto image =
                std::find_if(volumes_.images.begin(), volumes_.images.end(),
                             [&](const SurfaceVolumes::Image& one) { return one.distance_radii == distance_radii; });
            of_neighbours.push_back(image->map.get());
        }
        image_.push_back(std::move(of_neighbours));
    }
}

VolumeSpaceEffect::~VolumeSpaceEffect() = default;

SidedFactor<double> VolumeSpaceEffect::at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) {
    return at_turned_rotor(rotor, hub_m, level_attitude);
}

SidedFactor<double> VolumeSpaceEffect::at_body(const dynamics::LaneVector<double>& center_m) {
    return at_turned_body(center_m, level_attitude);
}

VolumeSpaceEffect::Losses VolumeSpaceEffect::neighbours_take(int rotor, const Vector3& hub_m,
                                                             const dynamics::LaneRotation<double>& attitude) {
    const auto which = static_cast<std::size_t>(rotor);
    place_at({hub_m[0], hub_m[1], hub_m[2]}, attitude, rotors_->neighbours_m[which], places_m_);
    Losses all;
    SidedFactor<double> own{1, 1};  // of the image that was looked at last
    for (std::size_t i = 0; i < places_m_.size(); ++i) {
        const VolumeMap& image = *image_[which][i];
        if (i == 0 || &image != image_[which][i - 1]) {
            own = image.sided_factor(hub_m);
        }
        const SidedFactor<double> other = image.sided_factor(places_m_[i]);
        all.ground += std::max(0.0, std::min(own.all - own.above, other.all - other.above));
        all.ceiling += std::max(0.0, std::min(own.above, other.above) - 1);
    }
    return all;
}

SidedFactor<double> VolumeSpaceEffect::at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                                       const dynamics::LaneRotation<double>& attitude) {
    const SidedFactor<double> alone = patches_[static_cast<std::size_t>(rotor)].at(hub_m.x, hub_m.y, hub_m.z);
    if (image_.empty() || (alone.all == 1 && alone.above == 1)) {
        return alone;
    }
    const Losses taken = neighbours_take(rotor, {hub_m.x, hub_m.y, hub_m.z}, attitude);
    double ground = alone.all - alone.above + 1;
    double ceiling = alone.above;
    if (volumes_.has_ground_images) {
        ground = factor_with_loss(1 - 1 / std::max(1.0, ground) + taken.ground, max_factor_);
    }
    if (volumes_.has_ceiling_images) {
        ceiling = factor_with_loss(1 - 1 / std::max(1.0, ceiling) + taken.ceiling, max_factor_);
    }
    return {lane::clamp(1 + (ground - 1) + (ceiling - 1), 0.0, max_factor_), lane::clamp(ceiling, 0.0, max_factor_)};
}

SidedFactor<double> VolumeSpaceEffect::at_turned_body(const dynamics::LaneVector<double>& center_m,
                                                      const dynamics::LaneRotation<double>& attitude) {
    if (volumes_.fountain == nullptr) {
        return {1, 1};
    }
    place_at(center_m, attitude, rotors_->from_center_m, places_m_);
    double sum = 0;
    for (const Vector3& hub_m : places_m_) {
        sum += volumes_.fountain->factor(hub_m);
    }
    return {sum / static_cast<double>(places_m_.size()), 1};
}

dynamics::LaneVector<double> VolumeSpaceEffect::wall_nearness(const dynamics::LaneVector<double>& center_m) {
    if (walls_.empty()) {
        return {0, 0, 0};
    }
    const SidedFactor<double> towards = walls_.front().at(center_m.x, center_m.y, center_m.z);
    return {towards.all, towards.above, 0};
}

bool VolumeSpaceEffect::is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) {
    const double margin_m = patches_[static_cast<std::size_t>(rotor)].margin_m(hub_m.x, hub_m.y, hub_m.z);
    return margin_m == 0 ? volumes_.rotor->effect().is_flyable({hub_m.x, hub_m.y, hub_m.z}) : margin_m > 0;
}

}  // namespace simulation
}  // namespace downwash
