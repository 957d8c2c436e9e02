#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "downwash/aeromap/aero_map.hpp"
#include "random.hpp"

namespace downwash::test {

/// A map against direct evaluation, at hubs in its layers.
struct MapComparison {
    const AeroMap& map;
    double worst = 0;  ///< greatest difference of K, of its part from above, and of K at tilts of 10 and 30 degrees
    int points = 0;    ///< compared

    /// @return the direct factor where the hub is within the map and flyable
    std::optional<double> look(std::size_t layer, double x_m, double z_m) {
        const Bounds& extent = map.extent();
        if (x_m < extent.x_low_m || x_m > extent.x_high_m || z_m < extent.z_low_m || z_m > extent.z_high_m ||
            !map.is_flyable(layer, x_m, z_m)) {
            return std::nullopt;
        }
        const MapLayer& from = map.layers()[layer];
        const SidedFactor<double> direct = from.effect->sided_factor(map.plane().to_world(x_m, from.lateral_m, z_m));
        const SidedFactor<double> looked_up = map.sided_factor(layer, x_m, z_m);
        worst = std::max(
            {worst, std::abs(map.factor(layer, x_m, z_m) - direct.all), std::abs(looked_up.above - direct.above)});
        for (const double sine : {0.17, 0.5}) {
            const TiltLoss loss{default_ground_tilt_loss, 0};
            worst = std::max(worst, std::abs(tilted(looked_up, loss, sine).all - tilted(direct, loss, sine).all));
        }
        ++points;
        return direct.all;
    }
};

/// A hub about the edge of a random part's shadow, where a map is at its worst: the disc begins to cover the part, or
/// covers a corner of it, at any height from the least clearance to a radius more above or below it. The shadow is
/// taken as that of the part's bounding box. Not always flyable. @pre the scene has parts
inline Vector3 near_shadow_edge(Random& random, const DirectEffect& effect) {
    const Scene& scene = effect.scene();
    const double radius_m = effect.rotor_radius_m();
    const auto part = static_cast<std::size_t>(random.integer(0, static_cast<int>(scene.part_count()) - 1));
    const BoundingBox bounds = scene.part_bounds(part);
    const int along = random.integer(0, 2);  // 2: a corner
    Vector3 hub_m{};
    for (int axis = 0; axis < 2; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        hub_m[i] = axis == along ? random.uniform(bounds.low_m[i], bounds.high_m[i])
                                 : (random.integer(0, 1) == 0 ? bounds.low_m[i] : bounds.high_m[i]);
    }
    const double angle = random.uniform(-3.1416, 3.1416);
    const double away_m = radius_m * (random.integer(0, 1) == 0 ? random.uniform(0.95, 1.05) : random.uniform(0, 1.1));
    hub_m[0] += away_m * std::cos(angle);
    hub_m[1] += away_m * std::sin(angle);
    const double far = random.uniform(0, 1);
    const double gap_m = effect.min_clearance_m() + far * far * radius_m;
    hub_m[2] = random.integer(0, 1) == 0 ? bounds.low_m[2] - gap_m : bounds.high_m[2] + gap_m;
    return hub_m;
}

/// The last flyable hub before the least clearance on the way between two, of which just one is flyable.
inline std::optional<Vector3> at_rim(const DirectEffect& effect, const Vector3& from_m, const Vector3& to_m) {
    if (effect.is_flyable(from_m) == effect.is_flyable(to_m)) {
        return std::nullopt;
    }
    Vector3 flyable_m = effect.is_flyable(from_m) ? from_m : to_m;
    Vector3 forbidden_m = effect.is_flyable(from_m) ? to_m : from_m;
    for (int halving = 0; halving < 20; ++halving) {
        const Vector3 middle_m{0.5 * (flyable_m[0] + forbidden_m[0]), 0.5 * (flyable_m[1] + forbidden_m[1]),
                               0.5 * (flyable_m[2] + forbidden_m[2])};
        (effect.is_flyable(middle_m) ? flyable_m : forbidden_m) = middle_m;
    }
    return flyable_m;
}

}  // namespace downwash::test
