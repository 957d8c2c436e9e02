#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "../support/meshes.hpp"

namespace downwash::test {

Obstacle any_obstacle(Random& random, const Vector3& center_m) {
    const auto size = [&](double low, double high) { return random.uniform(low, high); };
    Obstacle obstacle{"", Sphere{size(0.1, 0.6)}, center_m, {0, 0, size(-3, 3)}};
    switch (random.integer(0, 5)) {
        case 0:
            obstacle.shape = Box{{size(0.1, 1.5), size(0.1, 1.5), size(0.05, 0.6)}};
            break;
        case 1:
            obstacle.shape = Box{{size(0.1, 1), size(0.1, 1), size(0.05, 0.6)}};
            obstacle.rpy_rad = {size(-3, 3), size(-3, 3), size(-3, 3)};
            break;
        case 2:
            obstacle.shape = Cylinder{size(0.05, 0.4), size(0.1, 1.5), {size(-1, 1), size(-1, 1), size(-1, 1)}};
            break;
        case 3:
            obstacle.shape = Cylinder{size(0.05, 0.4), size(0.3, 1.5), {0, 1, 0}};
            break;
        case 4:
            obstacle.shape = Cylinder{size(0.05, 0.4), size(0.3, 1.5), {0, 0, 1}};
            break;
        default:
            break;
    }
    return obstacle;
}

Vector3 any_point(Random& random, const Vector3& half_m) {
    return {random.uniform(-half_m[0], half_m[0]), random.uniform(-half_m[1], half_m[1]),
            random.uniform(-half_m[2], half_m[2])};
}

std::vector<Obstacle> any_obstacles(Random& random, int count, const Vector3& half_m) {
    std::vector<Obstacle> obstacles;
    for (int i = 0; i < count; ++i) {
        obstacles.push_back(any_obstacle(random, any_point(random, half_m)));
    }
    return obstacles;
}

std::vector<Obstacle> bridge() {
    return {{"ground", Box{{40, 40, 1}}, {0, 0, -0.5}, {}},
            {"deck", Box{{30, 8, 1}}, {0, 0, 10.5}, {}},
            {"left girder", Box{{30, 0.4, 0.6}}, {0, 1, 9.7}, {}},
            {"right girder", Box{{30, 0.4, 0.6}}, {0, -1, 9.7}, {}},
            {"pier", Box{{1.5, 4, 10}}, {3, 0, 5}, {}},
            {"pipe", Cylinder{0.25, 10, {0, 1, 0}}, {0, 0, 4}, {}},
            {"ball", Sphere{1.5}, {6, 0, 3}, {}},
            {"post", Cylinder{0.8, 10, {0, 0, 1}}, {-9, 0, 5}, {}},
            {"long pipe", Cylinder{0.15, 16, {1, 0, 0}}, {-2, 0.2, 8.9}, {}},
            {"block", Box{{1, 1, 1}}, {-5, 0, 2}, {0.3, 0.4, 0.5}}};
}

DirectEffect::Factors by_rays(const DirectEffect& effect, const Vector3& hub_m, int side) {
    const AeroSettings& settings = effect.settings();
    const double radius = effect.rotor_radius_m();
    const double unit_m = effect.rotor_radius_m();
    double below_sum = 0;
    double above_sum = 0;
    long rays = 0;
    for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) {
            const double u = (2 * i + 1.0) / side - 1;
            const double v = (2 * k + 1.0) / side - 1;
            if (u * u + v * v > 1) {
                continue;
            }
            ++rays;
            double below = std::numeric_limits<double>::infinity();
            double above = below;
            for (std::size_t o = 0; o < effect.scene().part_count(); ++o) {
                const Interval extent = effect.scene().vertical_extent(o, hub_m[0] + u * radius, hub_m[1] + v * radius);
                if (!extent.empty() && extent.low <= hub_m[2]) {
                    below = std::min(below, std::max(0.0, hub_m[2] - extent.high));
                }
                if (!extent.empty() && extent.high >= hub_m[2]) {
                    above = std::min(above, std::max(0.0, extent.low - hub_m[2]));
                }
            }
            below_sum += effect.ground()(below / unit_m);
            above_sum += effect.ceiling()(above / unit_m);
        }
    }
    const auto count = static_cast<double>(rays);
    return {below_sum / count, above_sum / count,
            std::min(below_sum / count + above_sum / count - 1, settings.max_factor)};
}

std::vector<MapLayer> layers(const std::shared_ptr<const DirectEffect>& effect, const std::vector<double>& lateral_m) {
    std::vector<MapLayer> all;
    for (const double lateral : lateral_m) {
        all.push_back({effect, lateral});
    }
    return all;
}

std::shared_ptr<const Scene> scene_of(std::vector<Obstacle> obstacles) {
    return std::make_shared<const Scene>(std::move(obstacles));
}

DirectEffect effect_of(std::vector<Obstacle> obstacles, const AeroSettings& settings) {
    return {scene_of(std::move(obstacles)), settings, 0.2};
}

Mesh some_triangles(Random& random, int count, const Vector3& half_m, double size_m) {
    std::vector<std::array<Vector3, 3>> triangles(static_cast<std::size_t>(count));
    for (auto& corners : triangles) {
        const Vector3 around = any_point(random, half_m);
        for (Vector3& corner : corners) {
            const Vector3 away = any_point(random, {size_m, size_m, size_m});
            corner = {around[0] + away[0], around[1] + away[1], around[2] + away[2]};
        }
    }
    return soup_of(triangles);
}

std::shared_ptr<const DirectEffect> effect_in(std::vector<Obstacle> obstacles, double radius_m,
                                              const AeroSettings& settings) {
    return std::make_shared<const DirectEffect>(scene_of(std::move(obstacles)), settings, radius_m);
}

}  // namespace downwash::test
