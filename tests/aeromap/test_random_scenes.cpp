// What holds of the effect in any scene, over scenes of random obstacles of every kind: level and tilted boxes,
// cylinders along any axis, spheres, meshes (closed ones and loose triangles) and octrees.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "../support/meshes.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::effect_of;

namespace {

constexpr double radius = 0.2;

/// What direct_effect.hpp allows one evaluation near many parts; two of them may differ by twice that.
constexpr double quadrature_error = 5e-3;

Vector3 anywhere(test::Random& random, double size_m) {
    return test::any_point(random, {size_m, size_m, size_m});
}

Octomap lumps(test::Random& random) {
    const Vector3 half{random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), random.uniform(0.1, 0.5)};
    const auto is_inside = [&](const Vector3& p) {
        return std::hypot(p[0] / half[0], p[1] / half[1], p[2] / half[2]) < 1;
    };
    return test::octree_of(is_inside, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0.1);
}

constexpr int kinds = 10;

/// An obstacle of a kind: six of primitives, four of meshes and octrees.
Obstacle obstacle_of(int kind, test::Random& random, const Vector3& center_m) {
    if (kind < 6) {
        return test::any_obstacle(random, center_m);
    }
    const bool is_level = random.integer(0, 1) == 0;
    Obstacle obstacle{"", Shape{}, center_m, is_level ? Vector3{0, 0, random.uniform(-3, 3)} : anywhere(random, 3)};
    switch (kind) {
        case 6:
            obstacle.shape = test::box_mesh({random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)});
            break;
        case 7:
            obstacle.shape = test::pipe_mesh(random.uniform(0.1, 0.4), random.uniform(0.3, 1.5), 12, 3);
            break;
        case 8:
            obstacle.shape = test::stretched(test::some_triangles(random, 20, {0.4, 0.4, 0.4}, 0.3), {1, 1, 0.2});
            break;
        default:
            obstacle.shape = lumps(random);
    }
    return obstacle;
}

/// Obstacles of random kinds around the origin.
std::vector<Obstacle> some_obstacles(test::Random& random, int count, double size_m = 0.8) {
    std::vector<Obstacle> all;
    for (int i = 0; i < count; ++i) {
        all.push_back(obstacle_of(random.integer(0, kinds - 1), random, anywhere(random, size_m)));
    }
    return all;
}

BoundingBox bounds_of(const Obstacle& obstacle) {
    return Scene({obstacle}).bounds(0);
}

/// Moved up or down so that it ends at a height: its top where `is_below`, else its lower side.
Obstacle ending_at(Obstacle obstacle, double z_m, bool is_below) {
    const BoundingBox bounds = bounds_of(obstacle);
    obstacle.center_world_m[2] += z_m - (is_below ? bounds.high_m[2] : bounds.low_m[2]);
    return obstacle;
}

std::vector<Obstacle> joined(std::vector<Obstacle> one, const std::vector<Obstacle>& other) {
    one.insert(one.end(), other.begin(), other.end());
    return one;
}

double side_of(const DirectEffect::Factors& factors, bool is_below) {
    return is_below ? factors.ground : factors.ceiling;
}

Mesh mirrored(const Mesh& mesh) {
    return test::stretched(mesh, {1, -1, 1});
}

Octomap mirrored(const Octomap& octomap) {
    OccupancyTree tree = *octomap.tree;
    for (OccupiedCube& cube : tree.cubes) {
        cube.center_local_m[1] = -cube.center_local_m[1];
    }
    return {"", std::make_shared<const OccupancyTree>(std::move(tree))};
}

Cylinder mirrored(Cylinder cylinder) {
    cylinder.axis[1] = -cylinder.axis[1];
    return cylinder;
}

/// A box or a sphere is its own mirror image.
template <class Symmetric>
Symmetric mirrored(const Symmetric& shape) {
    return shape;
}

/// The obstacle on the other side of the plane y = 0: its own frame is mirrored likewise, so that its pitch stays.
Obstacle mirrored(Obstacle obstacle) {
    obstacle.shape = std::visit([](const auto& shape) { return Shape(mirrored(shape)); }, obstacle.shape);
    obstacle.center_world_m[1] = -obstacle.center_world_m[1];
    obstacle.rpy_rad[0] = -obstacle.rpy_rad[0];
    obstacle.rpy_rad[2] = -obstacle.rpy_rad[2];
    return obstacle;
}

/// An obstacle whose shadow holds the whole disc of 0.15 m about its centre, flat where its kind can be.
Obstacle shade(int kind, test::Random& random) {
    const auto size = [&] { return random.uniform(0.5, 1); };
    const auto tilt = [&] { return random.uniform(-0.4, 0.4); };
    Obstacle obstacle{"", Sphere{random.uniform(0.16, 0.5)}, {}, {tilt(), tilt(), random.uniform(-3, 3)}};
    switch (kind) {
        case 0:
            obstacle.shape = Box{{size(), size(), 0.05}};
            obstacle.rpy_rad = {0, 0, random.uniform(-3, 3)};
            break;
        case 1:
            obstacle.shape = Box{{size(), size(), 0.05}};
            break;
        case 2:
            obstacle.shape = Cylinder{random.uniform(0.2, 0.3), size(), anywhere(random, 1)};
            break;
        case 3:
            obstacle.shape = test::box_mesh({size(), size(), 0.05});
            break;
        case 4:
            obstacle.shape =
                test::octree_of([](const Vector3&) { return true; }, {-0.3, -0.3, -0.05}, {0.3, 0.3, 0.05}, 0.05);
            break;
        default:
            break;
    }
    return obstacle;
}

constexpr int shade_kinds = 6;

}  // namespace

TEST_CASE("The farther an obstacle of any kind below or above, the weaker its effect") {
    test::Random random(81);
    int felt[kinds] = {};
    for (int round = 0; round < 1000; ++round) {
        const int kind = round % kinds;
        const bool is_below = random.integer(0, 1) == 0;
        const Obstacle obstacle = ending_at(obstacle_of(kind, random, anywhere(random, 0.2)), 0, is_below);
        const DirectEffect effect = effect_of({obstacle});
        const Vector3 over = anywhere(random, 0.2);
        const auto above_one = [&](double distance_m) {
            const DirectEffect::Factors factors =
                effect.factors({over[0], over[1], is_below ? distance_m : -distance_m});
            REQUIRE(side_of(factors, !is_below) == 1);
            return side_of(factors, is_below) - 1;
        };
        double last = above_one(0.35 * radius);
        for (double distance = 0.5; distance < 8; distance += 0.25) {
            CAPTURE(round, kind, is_below, distance);
            const double now = above_one(distance * radius);
            REQUIRE(now >= 0);
            REQUIRE(now <= last + quadrature_error);
            last = now;
        }
        // A radius farther at least a quarter of it is gone: over wide ground, by (2.9), three quarters from 1 R on and
        // half from 2 R on; under a wide ceiling, by (2.18), seven tenths and half.
        const double near = above_one(0.35 * radius);
        if (near > 0.05) {
            ++felt[kind];
            REQUIRE(above_one(1.35 * radius) < 0.75 * near);
        }
    }
    for (int kind = 0; kind < kinds; ++kind) {
        CAPTURE(kind);
        CHECK(felt[kind] > 5);
    }
}

TEST_CASE("In any scene what is below and what is above act by themselves and add up to the cap") {
    test::Random random(87);
    int both_felt = 0;
    int capped = 0;
    for (int round = 0; round < 600; ++round) {
        const int count = random.integer(1, 3);
        std::vector<Obstacle> below = some_obstacles(random, count, 0.3);
        std::vector<Obstacle> above = some_obstacles(random, count, 0.3);
        for (std::size_t i = 0; i < below.size(); ++i) {
            below[i] = ending_at(below[i], -random.uniform(0.05, 0.4), true);
            above[i] = ending_at(above[i], random.uniform(0.05, 0.4), false);
        }
        const Vector3 hub{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0};
        const DirectEffect::Factors alone_below = effect_of(below).factors(hub);
        const DirectEffect::Factors alone_above = effect_of(above).factors(hub);
        const DirectEffect::Factors both = effect_of(joined(below, above)).factors(hub);
        CAPTURE(round);
        REQUIRE(alone_below.ceiling == 1);
        REQUIRE(alone_above.ground == 1);
        REQUIRE(both.ground == Approx(alone_below.ground).epsilon(0).margin(2 * quadrature_error));
        REQUIRE(both.ceiling == Approx(alone_above.ceiling).epsilon(0).margin(2 * quadrature_error));
        REQUIRE(both.total == Approx(std::min(2.0, both.ground + both.ceiling - 1)).epsilon(1e-12));
        both_felt += both.ground > 1.03 && both.ceiling > 1.03;
        capped += both.total == 2;
    }
    CHECK(both_felt > 50);
    CHECK(capped > 0);
}

TEST_CASE("Away from any scene the effect fades at least as fast as over a wide floor and under a wide ceiling") {
    test::Random random(83);
    const AeroSettings settings;
    const EffectCurve ground(settings.ground, settings.max_factor);
    const EffectCurve ceiling(settings.ceiling, settings.max_factor);
    for (int round = 0; round < 100; ++round) {
        const std::vector<Obstacle> obstacles = some_obstacles(random, 4);
        const DirectEffect effect = effect_of(obstacles);
        double low_m = 0;
        double high_m = 0;
        for (const Obstacle& obstacle : obstacles) {
            low_m = std::min(low_m, bounds_of(obstacle).low_m[2]);
            high_m = std::max(high_m, bounds_of(obstacle).high_m[2]);
        }
        const Vector3 at = anywhere(random, 0.8);
        for (const double distance_m : {1.0, 3.0, 10.0, 60.0}) {
            CAPTURE(round, distance_m);
            const DirectEffect::Factors over = effect.factors({at[0], at[1], high_m + distance_m});
            REQUIRE(over.ceiling == 1);
            REQUIRE(over.ground >= 1);
            REQUIRE(over.ground <= ground(distance_m / radius) + 1e-9);
            const DirectEffect::Factors under = effect.factors({at[0], at[1], low_m - distance_m});
            REQUIRE(under.ground == 1);
            REQUIRE(under.ceiling >= 1);
            REQUIRE(under.ceiling <= ceiling(distance_m / radius) + 1e-9);
        }
        REQUIRE(effect.factor({at[0], at[1], high_m + 60}) == Approx(1).epsilon(0).margin(1e-5));
        REQUIRE(effect.factor({at[0], at[1], low_m - 60}) == Approx(1).epsilon(0).margin(1e-5));
        // Beside everything no vertical line meets anything: centres are within 0.8 m, reaches below 1.3 m.
        REQUIRE(effect.factor({3, at[1], at[2]}) == 1);
        REQUIRE(effect.factor({at[0], -3, at[2]}) == 1);
    }
}

TEST_CASE("An obstacle of any kind wholly behind another, as seen from the disc, changes nothing") {
    test::Random random(84);
    int felt_without[kinds] = {};
    for (int round = 0; round < 1200; ++round) {
        const int kind = round % kinds;
        const bool is_below = random.integer(0, 1) == 0;
        const auto away = [is_below](double distance_m) { return is_below ? -distance_m : distance_m; };
        const Obstacle front = ending_at(shade(random.integer(0, shade_kinds - 1), random), away(0.08), is_below);
        // As large as it may be within the shadow, and right behind.
        Obstacle hidden = obstacle_of(kind, random, {});
        const BoundingBox bounds = bounds_of(hidden);
        const double reach_m =
            std::max({std::hypot(bounds.low_m[0], bounds.low_m[1]), std::hypot(bounds.low_m[0], bounds.high_m[1]),
                      std::hypot(bounds.high_m[0], bounds.low_m[1]), std::hypot(bounds.high_m[0], bounds.high_m[1])});
        const double scale = 0.149 / reach_m;
        std::visit(
            [scale](auto& shape) {
                using Kind = std::decay_t<decltype(shape)>;
                if constexpr (std::is_same_v<Kind, Box>) {
                    for (double& size : shape.size_m) {
                        size *= scale;
                    }
                } else if constexpr (std::is_same_v<Kind, Cylinder>) {
                    shape.radius_m *= scale;
                    shape.length_m *= scale;
                } else if constexpr (std::is_same_v<Kind, Sphere>) {
                    shape.radius_m *= scale;
                } else if constexpr (std::is_same_v<Kind, Mesh>) {
                    shape.scale *= scale;
                } else {
                    OccupancyTree tree = *shape.tree;
                    tree.resolution_m *= scale;
                    for (OccupiedCube& cube : tree.cubes) {
                        cube.side_m *= scale;
                        for (double& coordinate : cube.center_local_m) {
                            coordinate *= scale;
                        }
                    }
                    shape.tree = std::make_shared<const OccupancyTree>(std::move(tree));
                }
            },
            hidden.shape);
        const BoundingBox of_front = bounds_of(front);
        const double behind_m = is_below ? of_front.low_m[2] - 0.001 : of_front.high_m[2] + 0.001;
        hidden.center_world_m = {front.center_world_m[0], front.center_world_m[1], 0};
        hidden = ending_at(hidden, behind_m, is_below);

        const Vector3 hub{random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), 0};
        const DirectEffect::Factors alone = effect_of({front}).factors(hub);
        const DirectEffect::Factors both = effect_of({front, hidden}).factors(hub);
        CAPTURE(round, kind, is_below, side_of(alone, is_below), side_of(both, is_below));
        REQUIRE(std::abs(side_of(both, is_below) - side_of(alone, is_below)) < 2 * quadrature_error);
        REQUIRE(side_of(both, !is_below) == 1);
        felt_without[kind] += side_of(effect_of({hidden}).factors(hub), is_below) > 1 + 2 * quadrature_error;
    }
    for (int kind = 0; kind < kinds; ++kind) {
        CAPTURE(kind);
        CHECK(felt_without[kind] > 3);
    }
}

TEST_CASE("Mirroring any scene and the rotor together changes nothing") {
    test::Random random(85);
    int felt = 0;
    for (int round = 0; round < 600; ++round) {
        const std::vector<Obstacle> here = some_obstacles(random, 3, 0.5);
        std::vector<Obstacle> there;
        for (const Obstacle& obstacle : here) {
            there.push_back(mirrored(obstacle));
        }
        const Vector3 hub = anywhere(random, 0.6);
        const DirectEffect first = effect_of(here);
        const DirectEffect second = effect_of(there);
        const Vector3 reflection{hub[0], -hub[1], hub[2]};
        CAPTURE(round);
        REQUIRE(first.is_flyable(hub) == second.is_flyable(reflection));
        const DirectEffect::Factors a = first.factors(hub);
        const DirectEffect::Factors b = second.factors(reflection);
        if (first.is_flyable(hub)) {
            REQUIRE(b.ground == Approx(a.ground).epsilon(0).margin(2 * quadrature_error));
            REQUIRE(b.ceiling == Approx(a.ceiling).epsilon(0).margin(2 * quadrature_error));
            felt += a.total > 1.03;
        }
    }
    CHECK(felt > 30);
}

TEST_CASE("Obstacles that are not over or under the disc change nothing, however many they are") {
    test::Random random(29);
    std::vector<Obstacle> all;
    for (int i = 0; i < 400; ++i) {
        all.push_back(obstacle_of(random.integer(0, 5), random, test::any_point(random, {5, 5, 1.5})));
    }
    const DirectEffect effect = effect_of(all);
    int felt = 0;
    for (int i = 0; i < 300; ++i) {
        const Vector3 hub_m = test::any_point(random, {5, 5, 1.5});
        std::vector<Obstacle> near;
        for (const Obstacle& obstacle : all) {
            const BoundingBox bounds = bounds_of(obstacle);
            if (bounds.low_m[0] < hub_m[0] + radius && bounds.high_m[0] > hub_m[0] - radius &&
                bounds.low_m[1] < hub_m[1] + radius && bounds.high_m[1] > hub_m[1] - radius) {
                near.push_back(obstacle);
            }
        }
        const DirectEffect::Factors found = effect.factors(hub_m);
        const DirectEffect::Factors alone = effect_of(near).factors(hub_m);
        felt += alone.total > 1.01;
        CAPTURE(hub_m, near.size());
        REQUIRE(found.ground == alone.ground);
        REQUIRE(found.ceiling == alone.ceiling);
    }
    CHECK(felt > 100);
}
