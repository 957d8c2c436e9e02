#include "downwash/judge/ray_effect.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace downwash::judge {
namespace {

/// Points of the unit disc, each for as much of its area: along a spiral with the golden angle between them.
const std::vector<Planar>& disc_points() {
    static const std::vector<Planar> points = [] {
        constexpr int count = 512;
        const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
        std::vector<Planar> all;
        for (int i = 0; i < count; ++i) {
            const double radius = std::sqrt((i + 0.5) / count);
            all.push_back({radius * std::cos(turn * i), radius * std::sin(turn * i)});
        }
        return all;
    }();
    return points;
}

/// K of a side is the mean of a curve over one disc.
bool is_of_one_disc(const EffectCurve& curve) {
    return !is_multirotor(curve.effect().model) && !curve.depends_on_wall();
}

}  // namespace

std::shared_ptr<const RayEffect> RayEffect::made_for(const std::vector<Obstacle>& obstacles,
                                                     std::shared_ptr<const FlightModel> model) {
    const DirectEffect& effect = model->effect(0);
    if (model->scene().part_count() <= many_parts || effect.settings().map || !is_of_one_disc(effect.ground()) ||
        !is_of_one_disc(effect.ceiling())) {
        return nullptr;
    }
    return std::make_shared<const RayEffect>(VerticalRays(obstacles, 0.25 * effect.rotor_radius_m()), std::move(model));
}

RayEffect::RayEffect(VerticalRays rays, std::shared_ptr<const FlightModel> model)
    : rays_(std::move(rays)), model_(std::move(model)) {}

SidedFactor<double> RayEffect::at_rotor(int rotor, Planar hub_m) const {
    const DirectEffect& effect = model_->effect(rotor);
    const double radius_m = effect.rotor_radius_m();
    const Vector3 center_m = model_->plane().to_world(hub_m.x, model_->rotor_lateral_m(rotor), hub_m.z);
    double below = 0;
    double above = 0;
    for (const Planar& point : disc_points()) {
        const auto gaps = rays_.gaps(center_m[0] + radius_m * point.x, center_m[1] + radius_m * point.z, center_m[2]);
        below += effect.ground()(gaps.below_m / radius_m) - 1;
        above += effect.ceiling()(gaps.above_m / radius_m) - 1;
    }
    const auto count = static_cast<double>(disc_points().size());
    const double most = effect.settings().max_factor;
    return {std::clamp(1 + (below + above) / count, 0.0, most), std::clamp(1 + above / count, 0.0, most)};
}

RayEffect::Tangent RayEffect::tangent(int rotor, Planar hub_m) const {
    const double step_m = 0.05 * model_->effect(rotor).rotor_radius_m();
    const SidedFactor<double> here = at_rotor(rotor, hub_m);
    const auto slope = [&](Planar step) {
        const SidedFactor<double> there = at_rotor(rotor, hub_m + step);
        return SidedFactor<double>{(there.all - here.all) / step_m, (there.above - here.above) / step_m};
    };
    return {hub_m, here, slope({step_m, 0}), slope({0, step_m})};
}

}  // namespace downwash::judge
