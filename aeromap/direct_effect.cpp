#include "downwash/aeromap/direct_effect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "downwash/aeromap/curve_mean.hpp"
#include "downwash/aeromap/disc_average.hpp"
#include "downwash/aeromap/footprint.hpp"
#include "downwash/aeromap/rotor_images.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

bool is_at_least(double x, double min) {
    return std::isfinite(x) && x >= min;
}

void inspect(const SurfaceEffect& effect, const std::string& key, std::vector<KeyError>& errors) {
    if (effect.model == EffectModel::table && !effect.table) {
        errors.push_back({key + ".file", "must name a table of K"});
    }
    if (effect.d_over_r && !is_at_least(*effect.d_over_r, 0)) {
        errors.push_back({key + ".d_over_r", "must be a finite number of at least 0"});
    }
    const auto& parameters = info(effect.model).parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const ModelParameter& parameter = parameters[i];
        if (!parameter.allows(effect.parameters[i])) {
            errors.push_back({key + "." + std::string(parameter.name), "must be a number " + parameter.range_text()});
        }
    }
}

const AeroSettings& checked(const AeroSettings& settings, double radius_m) {
    std::vector<KeyError> errors;
    inspect(settings.ground, "aero.ground", errors);
    inspect(settings.ceiling, "aero.ceiling", errors);
    for (const auto& [loss, key] : {std::pair(settings.tilt_loss.ground, "aero.ground.tilt_loss"),
                                    std::pair(settings.tilt_loss.ceiling, "aero.ceiling.tilt_loss")}) {
        if (!is_at_least(loss, 0)) {
            errors.push_back({key, "must be a finite number of at least 0"});
        }
    }
    if (!(settings.wall.decay_radii > 0) || !std::isfinite(settings.wall.decay_radii)) {
        errors.push_back({"aero.wall.decay_radii", "must be a finite number above 0"});
    }
    for (const auto& [share, key] :
         {std::pair(settings.wall.force, "aero.wall.force"), std::pair(settings.wall.moment, "aero.wall.moment")}) {
        if (!std::isfinite(share)) {
            errors.push_back({key, "must be a finite number"});
        }
    }
    if (!is_at_least(settings.max_factor, 1)) {
        errors.push_back({"aero.max_factor", "must be a finite number of at least 1"});
    }
    if (!is_at_least(settings.min_distance_radii, 0)) {
        errors.push_back({"aero.min_distance_radii", "must be a finite number of at least 0"});
    }
    if (!(std::isfinite(radius_m) && radius_m > 0)) {
        errors.push_back({"robot.rotors.radius_m", "must be a finite length above 0 in metres"});
    }
    throw_if_any(std::move(errors));
    return settings;
}

/// In a scene the fountain of multirotor_body pushes the body, not the rotors.
SurfaceEffect on_rotor(const SurfaceEffect& effect) {
    return effect.model == EffectModel::multirotor_body ? SurfaceEffect(EffectModel::multirotor_images) : effect;
}

std::shared_ptr<const RotorImages> images_of(const SurfaceEffect& effect, const AeroSettings& settings, double radius_m,
                                             const RotorNeighbours& neighbours) {
    return is_multirotor(effect.model) ? std::make_shared<const RotorImages>(radius_m, settings.max_factor, neighbours)
                                       : nullptr;
}

std::shared_ptr<const CurveMean> mean_of(const EffectCurve& curve) {
    return curve.falls_with_distance() && !curve.is_none() && !curve.depends_on_wall()
               ? std::make_shared<const CurveMean>(curve)
               : nullptr;
}

}  // namespace

DirectEffect::DirectEffect(std::shared_ptr<const Scene> scene, const AeroSettings& settings, double rotor_radius_m,
                           const RotorNeighbours& neighbours)
    : scene_(std::move(scene)),
      settings_(checked(settings, rotor_radius_m)),
      rotor_radius_m_(rotor_radius_m),
      column_radius_m_(rotor_radius_m),
      min_clearance_m_(settings.min_distance_radii * rotor_radius_m),
      ground_(on_rotor(settings.ground), settings.max_factor, neighbours),
      ceiling_(settings.ceiling, settings.max_factor, neighbours),
      ground_mean_(mean_of(ground_)),
      ceiling_mean_(mean_of(ceiling_)),
      ground_images_(images_of(settings.ground, settings, rotor_radius_m, neighbours)),
      ceiling_images_(images_of(settings.ceiling, settings, rotor_radius_m, neighbours)),
      footprints_(std::make_shared<const Footprints>(*scene_, rotor_radius_m)) {}

DirectEffect DirectEffect::fountain(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                    double rotor_radius_m, const RotorNeighbours& neighbours) {
    DirectEffect effect(std::move(scene), settings, rotor_radius_m, neighbours);
    effect.ground_ = EffectCurve::fountain(settings.ground, settings.max_factor, neighbours);
    effect.ceiling_ = EffectCurve(EffectModel::none, settings.max_factor);
    effect.ground_mean_ = effect.ceiling_mean_ = nullptr;
    effect.ground_images_ = effect.ceiling_images_ = nullptr;
    effect.min_clearance_m_ = -std::numeric_limits<double>::infinity();
    std::vector<RotorNeighbours::Offset> hubs = neighbours.offsets_radii;
    hubs.push_back({0, 0});
    RotorNeighbours::Offset center{0, 0};
    for (const auto& [x, y] : hubs) {
        center.x += x / static_cast<double>(hubs.size());
        center.y += y / static_cast<double>(hubs.size());
    }
    for (const auto& [x, y] : hubs) {
        const Vector3 offset_m{rotor_radius_m * (x - center.x), rotor_radius_m * (y - center.y), 0};
        effect.fountain_hubs_m_.push_back(offset_m);
        effect.column_radius_m_ = std::max(
            effect.column_radius_m_, rotor_radius_m + std::sqrt(offset_m[0] * offset_m[0] + offset_m[1] * offset_m[1]));
    }
    return effect;
}

DirectEffect DirectEffect::fountain_on_disc(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                            double rotor_radius_m, const RotorNeighbours& neighbours) {
    DirectEffect effect = fountain(std::move(scene), settings, rotor_radius_m, neighbours);
    effect.fountain_hubs_m_ = {{0, 0, 0}};
    effect.column_radius_m_ = rotor_radius_m;
    return effect;
}

DirectEffect DirectEffect::image(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                 double rotor_radius_m, double distance_radii) {
    AeroSettings of_image = settings;
    of_image.ground = of_image.ceiling = EffectModel::none;
    of_image.map = nullptr;
    DirectEffect effect(std::move(scene), of_image, rotor_radius_m);
    for (const auto& [model, curve] :
         {std::pair(settings.ground.model, &effect.ground_), std::pair(settings.ceiling.model, &effect.ceiling_)}) {
        if (is_multirotor(model)) {
            *curve = EffectCurve::image(distance_radii, settings.max_factor);
        }
    }
    return effect;
}

DirectEffect DirectEffect::walls(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                 double rotor_radius_m, double reach_m, double heading_rad) {
    AeroSettings of_walls = settings;
    of_walls.ground = of_walls.ceiling = EffectModel::none;
    of_walls.map = nullptr;
    DirectEffect effect(std::move(scene), of_walls, rotor_radius_m);
    effect.min_clearance_m_ = -std::numeric_limits<double>::infinity();
    effect.wall_view_ = {reach_m, {std::cos(heading_rad), std::sin(heading_rad), 0}};
    return effect;
}

DirectEffect DirectEffect::walls_around(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                        double rotor_radius_m, double reach_m) {
    DirectEffect effect = walls(std::move(scene), settings, rotor_radius_m, reach_m, 0);
    effect.wall_view_->is_around = true;
    return effect;
}

Vector3 DirectEffect::towards_wall(const Vector3& center_m) const {
    const auto distance_m = [&](double x_m, double y_m) {
        return horizontal_clearance_m(*scene_, {center_m[0] + x_m, center_m[1] + y_m, center_m[2]});
    };
    if (!settings_.enabled || !is_finite(center_m)) {
        return {0, 0, 0};
    }
    const double here_m = distance_m(0, 0);
    if (!std::isfinite(here_m)) {
        return {0, 0, 0};
    }
    constexpr double step_m = 0.02;  // as in wall_nearness()
    const double x = (distance_m(-step_m, 0) - distance_m(step_m, 0)) / (2 * step_m);
    const double y = (distance_m(0, -step_m) - distance_m(0, step_m)) / (2 * step_m);
    const double gap_m = std::max(0.0, here_m - wall_view_->reach_m - rotor_radius_m_);
    const double size =
        std::exp(-gap_m / (settings_.wall.decay_radii * rotor_radius_m_)) / std::max(1.0, std::sqrt(x * x + y * y));
    return {size * x, size * y, 0};
}

double DirectEffect::wall_nearness(const Vector3& center_m) const {
    const auto distance_m = [&](double ahead_m) {
        const Vector3& ahead = wall_view_->ahead;
        return horizontal_clearance_m(
            *scene_, {center_m[0] + ahead_m * ahead[0], center_m[1] + ahead_m * ahead[1], center_m[2]});
    };
    const double here_m = distance_m(0);
    if (!std::isfinite(here_m)) {
        return 0;
    }
    // The distance falls as fast as the way leads towards the wall. Between two walls this step makes it change sides
    // without a jump.
    constexpr double step_m = 0.02;
    const double towards = lane::clamp((distance_m(-step_m) - distance_m(step_m)) / (2 * step_m), -1.0, 1.0);
    const double gap_m = std::max(0.0, here_m - wall_view_->reach_m - rotor_radius_m_);
    return towards * std::exp(-gap_m / (settings_.wall.decay_radii * rotor_radius_m_));
}

double DirectEffect::averaged(Side side, const Vector3& hub_m, const EffectCurve& curve) const {
    const CurveMean* mean = (side == Side::below ? ground_mean_ : ceiling_mean_).get();
    return disc_average({*scene_, hub_m, rotor_radius_m_, side, curve, rotor_radius_m_, mean}, *footprints_);
}

double DirectEffect::one_sided(Side side, const Vector3& hub_m, const std::span<const Vector3>* neighbours_m) const {
    const bool is_below = side == Side::below;
    const EffectCurve& curve = is_below ? ground_ : ceiling_;
    if (curve.is_none()) {
        return 1;
    }
    if (const RotorImages* images = (is_below ? ground_images_ : ceiling_images_).get()) {
        const DiscSide on{*scene_, *footprints_, side};
        return neighbours_m != nullptr ? images->factor(on, hub_m, *neighbours_m) : images->factor(on, hub_m);
    }
    if (is_below && !fountain_hubs_m_.empty()) {
        double sum = 0;
        for (const Vector3& offset_m : fountain_hubs_m_) {
            sum += averaged(side, {hub_m[0] + offset_m[0], hub_m[1] + offset_m[1], hub_m[2]}, curve);
        }
        return sum / static_cast<double>(fountain_hubs_m_.size());
    }
    return curve.depends_on_wall()
               ? averaged(side, hub_m, curve.at_wall(horizontal_clearance_m(*scene_, hub_m) / rotor_radius_m_))
               : averaged(side, hub_m, curve);
}

DirectEffect::Factors DirectEffect::factors(const Vector3& hub_m) const {
    Factors factors;
    if (!settings_.enabled) {
        return factors;
    }
    if (wall_view_) {
        factors.total = is_finite(hub_m) ? 1 + wall_nearness(hub_m) : 1;
        return factors;
    }
    if (settings_.map) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, settings_.map->contains(hub_m) ? settings_.map->factor(hub_m) : 1.0};
    }
    return superposed(one_sided(Side::below, hub_m), one_sided(Side::above, hub_m));
}

DirectEffect::Factors DirectEffect::superposed(double ground, double ceiling) const {
    return {ground, ceiling, lane::clamp(1 + (ground - 1) + (ceiling - 1), 0.0, settings_.max_factor)};
}

SidedFactor<double> DirectEffect::sided_factor(const Vector3& hub_m) const {
    const Factors k = factors(hub_m);
    return {k.total, settings_.map || wall_view_ ? k.total : lane::clamp(k.ceiling, 0.0, settings_.max_factor)};
}

SidedFactor<double> DirectEffect::sided_factor(const Vector3& hub_m, std::span<const Vector3> neighbours_m) const {
    if (!settings_.enabled || settings_.map || wall_view_ || !is_finite(hub_m) ||
        !(ground_images_ || ceiling_images_)) {
        return sided_factor(hub_m);
    }
    const Factors k =
        superposed(one_sided(Side::below, hub_m, &neighbours_m), one_sided(Side::above, hub_m, &neighbours_m));
    return {k.total, lane::clamp(k.ceiling, 0.0, settings_.max_factor)};
}

double DirectEffect::fountain_factor(std::span<const Vector3> hubs_m) const {
    if (!settings_.enabled || ground_.is_none() || hubs_m.empty()) {
        return 1;
    }
    double sum = 0;
    for (const Vector3& hub_m : hubs_m) {
        sum += is_finite(hub_m) ? averaged(Side::below, hub_m, ground_) : 1;
    }
    return lane::clamp(sum / static_cast<double>(hubs_m.size()), 0.0, settings_.max_factor);
}

double DirectEffect::largest_change_from_below(double beyond_radii) const {
    return ground_images_ ? ground_images_->largest_change_beyond(beyond_radii)
                          : ground_.largest_change_beyond(beyond_radii);
}

double DirectEffect::largest_change_from_above(double beyond_radii) const {
    return ceiling_images_ ? ceiling_images_->largest_change_beyond(beyond_radii)
                           : ceiling_.largest_change_beyond(beyond_radii);
}

bool DirectEffect::is_flyable(const Vector3& hub_m) const {
    if (!is_finite(hub_m)) {
        return false;
    }
    if (!settings_.enabled || min_clearance_m_ < 0) {
        return true;
    }
    return (!settings_.map || settings_.map->is_flyable(hub_m)) &&
           disc_is_clear(*scene_, hub_m, rotor_radius_m_, min_clearance_m_);
}

}  // namespace downwash
