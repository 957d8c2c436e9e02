#include "downwash/judge/space_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/rotor_layout.hpp"

namespace downwash::judge {
namespace {

Vector3 place_of(const Eigen::Vector3d& at_m) {
    return {at_m.x(), at_m.y(), at_m.z()};
}

/// A rotor alone: of models of several rotors it has its own image.
AeroSettings alone(AeroSettings aero) {
    for (SurfaceEffect* side : {&aero.ground, &aero.ceiling}) {
        if (is_multirotor(side->model)) {
            *side = EffectModel::cheeseman_bennett;
        }
    }
    return aero;
}

/// Level distance from the centre between the rotors to the farthest hub.
double reach_m(const std::vector<SpaceRotor>& rotors) {
    double x_m = 0, y_m = 0;
    for (const SpaceRotor& rotor : rotors) {
        x_m += rotor.position_m[0] / static_cast<double>(rotors.size());
        y_m += rotor.position_m[1] / static_cast<double>(rotors.size());
    }
    double most_m = 0;
    for (const SpaceRotor& rotor : rotors) {
        most_m = std::max(most_m, std::hypot(rotor.position_m[0] - x_m, rotor.position_m[1] - y_m));
    }
    return most_m;
}

}  // namespace

SpaceSurfaces::SpaceSurfaces(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero,
                             const SpaceRobot& robot)
    : aero_(aero),
      has_ground_images_(!aero.map && is_multirotor(aero.ground.model)),
      has_ceiling_images_(!aero.map && is_multirotor(aero.ceiling.model)),
      rotor_(scene, alone(aero), robot.rotor_radius_m) {
    const double radius_m = robot.rotor_radius_m;
    const std::vector<SpaceRotor>& rotors = robot.plant.rotors;
    if (has_ground_images_ || has_ceiling_images_) {
        constexpr double rounding = 1e-9;
        for (const SpaceRotor& one : rotors) {
            std::vector<std::size_t>& images = image_.emplace_back();
            for (const SpaceRotor& other : rotors) {
                const double distance_radii =
                    std::hypot(other.position_m[0] - one.position_m[0], other.position_m[1] - one.position_m[1]) /
                    radius_m;
                const auto known = std::find_if(images_.begin(), images_.end(), [&](const Image& image) {
                    return std::abs(image.distance_radii - distance_radii) < rounding;
                });
                images.push_back(static_cast<std::size_t>(known - images_.begin()));
                if (known == images_.end()) {
                    images_.push_back({distance_radii, DirectEffect::image(scene, aero, radius_m, distance_radii)});
                }
            }
        }
    }
    if (has_ground_images_ && aero.ground.model == EffectModel::multirotor_body) {
        std::vector<Vector3> hubs_m;
        hubs_m.reserve(rotors.size());
        for (const SpaceRotor& rotor : rotors) {
            hubs_m.push_back(rotor.position_m);
        }
        fountain_ = DirectEffect::fountain_on_disc(scene, aero, radius_m, neighbours_of(hubs_m, 0, radius_m));
    }
    if (aero.wall.is_any()) {
        walls_ = DirectEffect::walls_around(scene, aero, radius_m, reach_m(rotors));
    }
}

double SpaceSurfaces::with_images(double alone, double taken) const {
    const double left = 1 / alone - taken;  // of the induced velocity
    return left * aero_.max_factor > 1 ? 1 / left : aero_.max_factor;
}

std::vector<SidedFactor<double>> SpaceSurfaces::at_rotors(const std::vector<Eigen::Vector3d>& hubs_m) const {
    const std::size_t count = hubs_m.size();
    std::vector<SidedFactor<double>> all;
    // The mean of each image over each disc, as far as it is asked for.
    std::vector<std::optional<DirectEffect::Factors>> means(images_.size() * count);
    const auto mean = [&](std::size_t image, std::size_t rotor) {
        auto& known = means[image * count + rotor];
        if (!known) {
            known = images_[image].field.factors(place_of(hubs_m[rotor]));
        }
        return *known;
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (image_.empty()) {
            all.push_back(rotor_.sided_factor(place_of(hubs_m[i])));
            continue;
        }
        const DirectEffect::Factors alone = rotor_.factors(place_of(hubs_m[i]));
        double ground = alone.ground, ceiling = alone.ceiling;
        if (ground != 1 || ceiling != 1) {  // a disc with nothing below and above it has no images, either
            double below = 0, above = 0;    // what the images of the others take
            for (std::size_t other = 0; other < count; ++other) {
                if (other != i) {
                    const DirectEffect::Factors here = mean(image_[i][other], i), there = mean(image_[i][other], other);
                    below += std::min(here.ground, there.ground) - 1;
                    above += std::min(here.ceiling, there.ceiling) - 1;
                }
            }
            ground = has_ground_images_ ? with_images(ground, below) : ground;
            ceiling = has_ceiling_images_ ? with_images(ceiling, above) : ceiling;
        }
        const double most = aero_.max_factor;
        all.push_back({std::clamp(ground + ceiling - 1, 0.0, most), std::clamp(ceiling, 0.0, most)});
    }
    return all;
}

double SpaceSurfaces::fountain(const std::vector<Eigen::Vector3d>& hubs_m) const {
    double sum = 0;
    for (std::size_t i = 0; fountain_ && i < hubs_m.size(); ++i) {
        sum += fountain_->factor(place_of(hubs_m[i])) - 1;
    }
    return std::min(sum / static_cast<double>(hubs_m.size()), aero_.max_factor - 1);
}

Eigen::Vector3d SpaceSurfaces::towards_wall(const Eigen::Vector3d& center_m) const {
    if (!walls_) {
        return Eigen::Vector3d::Zero();
    }
    const Vector3 towards = walls_->towards_wall(place_of(center_m));
    return {towards[0], towards[1], towards[2]};
}

bool SpaceSurfaces::is_given_map_flyable(const Eigen::Vector3d& hub_m) const {
    return !aero_.map || rotor_.is_flyable(place_of(hub_m));
}

}  // namespace downwash::judge
