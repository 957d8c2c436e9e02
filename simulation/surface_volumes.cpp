#include "downwash/simulation/surface_volumes.hpp"

#include <algorithm>

#include "downwash/aeromap/map_cache.hpp"
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

SpaceVolumeViews views_of(const SurfaceVolumes& volumes, const SpaceRobot& robot) {
    const SpaceRotorPlaces places(robot);
    SpaceVolumeViews views;
    views.has_rotors = true;
    views.rotor = volumes.rotor->view();
    views.max_factor = volumes.rotor->effect().settings().max_factor;
    views.has_ground_images = volumes.has_ground_images;
    views.has_ceiling_images = volumes.has_ceiling_images;
    if (volumes.walls != nullptr) {
        views.has_walls = true;
        views.walls = volumes.walls->view();
    }
    if (volumes.fountain != nullptr) {
        views.has_fountain = true;
        views.fountain = volumes.fountain->view();
    }
    for (const SurfaceVolumes::Image& image : volumes.images) {
        views.image[views.image_count++] = image.map->view();
    }
    const auto lane_vector = [](const Vector3& v) { return dynamics::LaneVector<double>{v[0], v[1], v[2]}; };
    for (std::size_t i = 0; i < places.hubs_m.size(); ++i) {
        views.from_center_m[i] = lane_vector(places.from_center_m[i]);
        const std::vector<double> distances_radii = places.neighbours(i).distances_radii;
        for (std::size_t k = 0; k < distances_radii.size() && !volumes.images.empty(); ++k) {
            const auto image = std::find_if(
                volumes.images.begin(), volumes.images.end(),
                [&](const SurfaceVolumes::Image& one) { return one.distance_radii == distances_radii[k]; });
            views.neighbour[i][k] = {lane_vector(places.neighbours_m[i][k]), static_cast<int>(places.neighbour[i][k]),
                                     static_cast<int>(image - volumes.images.begin())};
        }
    }
    views.rotor_count = static_cast<int>(places.hubs_m.size());
    return views;
}

VolumeSpaceEffect::VolumeSpaceEffect(const SurfaceVolumes& volumes, const SpaceRobot& robot)
    : volumes_(volumes),
      views_(views_of(volumes, robot)),
      patches_(static_cast<std::size_t>(views_.patches())),
      field_(views_, patches_.data()) {}

SidedFactor<double> VolumeSpaceEffect::at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) {
    return field_.at_rotor(rotor, hub_m);
}

SidedFactor<double> VolumeSpaceEffect::at_body(const dynamics::LaneVector<double>& center_m) {
    return field_.at_body(center_m);
}

SidedFactor<double> VolumeSpaceEffect::at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                                       const dynamics::LaneRotation<double>& attitude) {
    return field_.at_turned_rotor(rotor, hub_m, attitude);
}

SidedFactor<double> VolumeSpaceEffect::at_turned_body(const dynamics::LaneVector<double>& center_m,
                                                      const dynamics::LaneRotation<double>& attitude) {
    return field_.at_turned_body(center_m, attitude);
}

dynamics::LaneVector<double> VolumeSpaceEffect::wall_nearness(const dynamics::LaneVector<double>& center_m) {
    return field_.wall_nearness(center_m);
}

bool VolumeSpaceEffect::is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) {
    const double margin_m = field_.margin_m(rotor, hub_m);
    return margin_m == 0 ? volumes_.rotor->effect().is_flyable({hub_m.x, hub_m.y, hub_m.z}) : margin_m > 0;
}

}  // namespace simulation
}  // namespace downwash
