#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/scene/scene.hpp"
#include "meshes.hpp"
#include "random.hpp"

// Sites of real sizes around which vehicles fly in space, and volumes in them against direct evaluation.

namespace downwash::test {

/// A site, and the block of space in which rotors fly.
struct VolumeSite {
    std::string name;
    std::vector<Obstacle> obstacles;
    double radius_m;  ///< of the rotors
    PlaneOfMotion frame;
    Bounds extent;
    double lateral_low_m, lateral_high_m;

    [[nodiscard]] std::shared_ptr<const DirectEffect> effect() const {
        return std::make_shared<const DirectEffect>(std::make_shared<const Scene>(obstacles), AeroSettings{}, radius_m);
    }
    [[nodiscard]] VolumeMap map(const std::shared_ptr<const DirectEffect>& effect) const {
        return {effect, frame, extent, lateral_low_m, lateral_high_m};
    }
    [[nodiscard]] Vector3 any(Random& random) const {
        const double x_m = random.uniform(extent.x_low_m, extent.x_high_m);
        const double lateral_m = random.uniform(lateral_low_m, lateral_high_m);
        return frame.to_world(x_m, lateral_m, random.uniform(extent.z_low_m, extent.z_high_m));
    }
};

/// Five girders 2.97 m apart under a deck, with cross frames of angles every 6.1 m: the sizes of the design example of
/// the FHWA for steel girders.
inline VolumeSite girder_bay() {
    std::vector<Obstacle> all{{"deck", Box{{14, 14, 0.216}}, {0, 0, 4}, {}}};
    for (int i = -2; i <= 2; ++i) {
        const double y_m = 2.97 * i;
        all.push_back({"web", Box{{14, 0.012, 1.37}}, {0, y_m, 3.2}, {}});
        all.push_back({"upper flange", Box{{14, 0.36, 0.03}}, {0, y_m, 3.875}, {}});
        all.push_back({"lower flange", Box{{14, 0.36, 0.03}}, {0, y_m, 2.5}, {}});
    }
    for (const double x_m : {-6.1, 0.0, 6.1}) {
        for (int i = -2; i < 2; ++i) {
            const double y_m = 2.97 * (i + 0.5);
            const double rise_rad = std::atan2(1.0, 2.97);
            all.push_back({"chord", Box{{0.1, 2.9, 0.1}}, {x_m, y_m, 2.7}, {}});
            all.push_back({"brace", Box{{0.1, 3.0, 0.1}}, {x_m, y_m, 3.2}, {rise_rad, 0, 0}});
            all.push_back({"brace", Box{{0.1, 3.0, 0.1}}, {x_m, y_m, 3.2}, {-rise_rad, 0, 0}});
        }
    }
    return {"girder bay", all, 0.229, {}, {-6, 6, 1.6, 3.9}, -7, 7};
}

/// Lines of several diameters on two tiers of a rack, turned against the world's axes.
inline VolumeSite pipe_rack() {
    const double turn_rad = 0.35;
    const PlaneOfMotion frame({1, 2, 0}, turn_rad);
    std::vector<Obstacle> all;
    const double radii_m[] = {0.05, 0.15, 0.3, 0.08, 0.2};
    for (const double z_m : {4.5, 6.5}) {
        for (int i = 0; i < 5; ++i) {
            all.push_back({"line",
                           Cylinder{radii_m[i], 14, {1, 0, 0}},
                           frame.to_world(0, 1.1 * (i - 2), z_m + 0.1 + radii_m[i]),
                           {0, 0, turn_rad}});
        }
        for (const double x_m : {-6.0, 0.0, 6.0}) {
            all.push_back({"beam", Box{{0.2, 6, 0.2}}, frame.to_world(x_m, 0, z_m), {0, 0, turn_rad}});
        }
    }
    for (const double x_m : {-6.0, 0.0, 6.0}) {
        for (const double y_m : {-3.0, 3.0}) {
            all.push_back({"column", Box{{0.25, 0.25, 7}}, frame.to_world(x_m, y_m, 3.5), {0, 0, turn_rad}});
        }
    }
    return {"pipe rack", all, 0.12, frame, {-4, 4, 3.4, 7.6}, -3.4, 3.4};
}

/// The rough underside of a deck as a mesh of 2 n^2 triangles over 20 m by 20 m, with a beam below it.
inline VolumeSite rough_deck(std::uint32_t n) {
    Random random(9);
    std::vector<Vector3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            vertices.push_back({-10 + 20.0 * i / n, -10 + 20.0 * j / n, random.uniform(3.8, 3.83)});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            const std::uint32_t d = a + n + 1;
            triangles.push_back({a, a + 1, d + 1});
            triangles.push_back({a, d + 1, d});
        }
    }
    return {"rough deck",
            {{"deck", mesh_of(std::move(vertices), std::move(triangles)), {}, {}},
             {"beam", Box{{20, 0.3, 0.5}}, {0, 0, 3.4}, {}}},
            0.229,
            {},
            {-6, 6, 2.4, 3.7},
            -6,
            6};
}

/// A volume against direct evaluation.
struct VolumeComparison {
    double worst = 0;   ///< difference of K, or of its part from above
    int flyable = 0;    ///< places compared
    int felt = 0;       ///< of them, where K differs by 0.02 from 1
    int misjudged = 0;  ///< places of which the volume says wrongly whether they are flyable
};

/// At as many random flyable places of a site.
inline VolumeComparison compared_at_random(const VolumeSite& site, const VolumeMap& map, int places, unsigned seed) {
    const DirectEffect& effect = map.effect();
    Random random(seed);
    VolumeComparison found;
    while (found.flyable < places) {
        const Vector3 hub_m = site.any(random);
        const bool is_flyable = effect.is_flyable(hub_m);
        found.misjudged += map.is_flyable(hub_m) != is_flyable ? 1 : 0;
        if (is_flyable) {
            const SidedFactor<double> direct = effect.sided_factor(hub_m);
            const SidedFactor<double> looked_up = map.sided_factor(hub_m);
            found.worst =
                std::max({found.worst, std::abs(looked_up.all - direct.all), std::abs(looked_up.above - direct.above)});
            found.felt += std::abs(direct.all - 1) > 0.02 ? 1 : 0;
            ++found.flyable;
        }
    }
    return found;
}

/// The hubs of a hexarotor on a flight of 20 s at half a metre a second, every hundredth of a second: along a bay of
/// girder_bay(), down, under a girder, up into the next bay, and back.
inline std::vector<Vector3> flight_in_girder_bay() {
    std::vector<Vector3> hubs_m;
    for (int tick = 0; tick <= 2000; ++tick) {
        const double way_m = 0.005 * tick;
        Vector3 center_m{-5 + std::min(way_m, 4.0), 1.485, 3.3};
        center_m[2] -= std::clamp(way_m - 4, 0.0, 1.4);
        center_m[1] -= std::clamp(way_m - 5.4, 0.0, 2.97);
        center_m[2] += std::clamp(way_m - 8.37, 0.0, 1.4);
        center_m[0] -= std::max(way_m - 9.77, 0.0);
        for (int rotor = 0; rotor < 6; ++rotor) {
            const double angle_rad = 0.5235987755982988 + 1.0471975511965976 * rotor;
            hubs_m.push_back({center_m[0] + 0.48 * std::cos(angle_rad), center_m[1] + 0.48 * std::sin(angle_rad),
                              center_m[2] + 0.05});
        }
    }
    return hubs_m;
}

}  // namespace downwash::test
