#include "downwash/aeromap/direct_effect.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "downwash/aeromap/disc_average.hpp"
#include "downwash/aeromap/footprint.hpp"
#include "downwash/base/fault.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

bool is_at_least(double x, double least) {
    return std::isfinite(x) && x >= least;
}

void inspect(const SurfaceEffect& effect, const std::string& key, std::vector<Fault>& faults) {
    if (!(std::isfinite(effect.k1) && effect.k1 > 0)) {
        faults.push_back({key + ".k1", "must be a finite number above 0"});
    }
    if (!is_at_least(effect.k2_over_radius, 0)) {
        faults.push_back({key + ".k2_over_radius", "must be a finite number of at least 0"});
    }
}

void require_valid(const AeroSettings& settings, double radius_m) {
    std::vector<Fault> faults;
    inspect(settings.ground, "aero.ground", faults);
    inspect(settings.ceiling, "aero.ceiling", faults);
    if (!is_at_least(settings.max_factor, 1)) {
        faults.push_back({"aero.max_factor", "must be a finite number of at least 1"});
    }
    if (!is_at_least(settings.min_distance_radii, 0)) {
        faults.push_back({"aero.min_distance_radii", "must be a finite number of at least 0"});
    }
    if (!(std::isfinite(radius_m) && radius_m > 0)) {
        faults.push_back({"robot.rotors.radius_m", "must be a finite length above 0 in metres"});
    }
    if (!faults.empty()) {
        throw InputError(std::move(faults));
    }
}

std::vector<Footprint> footprints_of(const Scene& scene) {
    std::vector<Footprint> footprints;
    footprints.reserve(scene.obstacles().size());
    for (std::size_t i = 0; i < scene.obstacles().size(); ++i) {
        footprints.emplace_back(scene, i);
    }
    return footprints;
}

}  // namespace

DirectEffect::DirectEffect(std::shared_ptr<const Scene> scene, const AeroSettings& settings, double rotor_radius_m)
    : scene_(std::move(scene)),
      settings_(settings),
      radius_m_(rotor_radius_m),
      footprints_(std::make_shared<const std::vector<Footprint>>(footprints_of(*scene_))) {
    require_valid(settings, rotor_radius_m);
    ground_kink_m_ = radius_m_ * kink_of(settings.ground, settings.max_factor);
    ceiling_kink_m_ = radius_m_ * kink_of(settings.ceiling, settings.max_factor);
}

DirectEffect::Factors DirectEffect::factors(const Vector3& hub_m) const {
    Factors factors;
    if (!settings_.enabled) {
        return factors;
    }
    const auto one_sided = [&](Side side, const SurfaceEffect& effect, double kink_m) {
        if (effect.model == EffectModel::none) {
            return 1.0;
        }
        return disc_average({*scene_, hub_m, radius_m_, side, effect, settings_.max_factor, kink_m}, *footprints_);
    };
    factors.ground = one_sided(Side::below, settings_.ground, ground_kink_m_);
    factors.ceiling = one_sided(Side::above, settings_.ceiling, ceiling_kink_m_);
    factors.total = lane::min(1 + (factors.ground - 1) + (factors.ceiling - 1), settings_.max_factor);
    return factors;
}

bool DirectEffect::is_flyable(const Vector3& hub_m) const {
    if (!(std::isfinite(hub_m[0]) && std::isfinite(hub_m[1]) && std::isfinite(hub_m[2]))) {
        return false;
    }
    return !settings_.enabled || disc_is_clear(*scene_, hub_m, radius_m_, settings_.min_distance_radii * radius_m_);
}

}  // namespace downwash
