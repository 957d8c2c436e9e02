#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/hard_places.hpp"
#include "../support/repetitions.hpp"
#include "downwash/aeromap/aero_map.hpp"
#include "downwash/effects/effect_models.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::scene_of;

namespace {

constexpr double radius = 0.1905;  // 15 inches across

AeroSettings with_ground(EffectModel model) {
    AeroSettings settings;
    settings.ground = model;
    return settings;
}

/// Hubs evenly around a circle, adjacent ones 2.6 radii apart.
std::vector<Vector3> ring(int rotors) {
    const double pi = std::acos(-1.0);
    const double circle_m = 1.3 * radius / std::sin(pi / rotors);
    std::vector<Vector3> hubs_m;
    for (int i = 0; i < rotors; ++i) {
        const double angle = 2 * pi * (i + 0.5) / rotors;
        hubs_m.push_back({circle_m * std::cos(angle), circle_m * std::sin(angle), 0});
    }
    return hubs_m;
}

Vector3 turned(const Vector3& p, double angle) {
    return {std::cos(angle) * p[0] - std::sin(angle) * p[1], std::sin(angle) * p[0] + std::cos(angle) * p[1], p[2]};
}

double distance_m(const Vector3& a, const Vector3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// A plate whose top is at z = 0, under the whole of a disc or under one half of it, and under no other disc.
Obstacle plate_under(const Vector3& hub_m, bool is_half) {
    const double half_side_m = 1.05 * radius;
    const double length_m = is_half ? half_side_m : 2 * half_side_m;
    return {"plate",
            Box{{length_m, 2 * half_side_m, 0.1}},
            {hub_m[0] + (is_half ? 0.5 * length_m : 0), hub_m[1], -0.05},
            {}};
}

/// The shares of the discs that are covered, from the digits of a number to the base of three.
std::vector<double> coverage(int number, std::size_t rotors) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < rotors; ++i) {
        shares.push_back(0.5 * (number % 3));
        number /= 3;
    }
    return shares;
}

/// (2.14) and (2.15) with every image weighted by what is covered.
double factor_by_hand(const std::vector<Vector3>& hubs_m, std::size_t i, const std::vector<double>& share,
                      double zeta) {
    const double alone = 1 / (1 - 1 / (16 * zeta * zeta));
    double loss = 1 - 1 / (1 + share[i] * (alone - 1));
    for (std::size_t j = 0; j < hubs_m.size(); ++j) {
        const double d = distance_m(hubs_m[i], hubs_m[j]) / radius;
        loss += j == i ? 0 : std::min(share[i], share[j]) * 0.5 * zeta / std::pow(d * d + 4 * zeta * zeta, 1.5);
    }
    return 1 / (1 - loss);
}

}  // namespace

TEST_CASE("A plate under one rotor alone acts on it as on a single rotor") {
    const std::vector<Vector3> hubs_m = ring(4);
    const auto plate = scene_of({plate_under(hubs_m[2], false)});
    for (std::size_t i = 0; i < 4; ++i) {
        const DirectEffect effect(plate, with_ground(EffectModel::multirotor_images), radius,
                                  neighbours_of(hubs_m, i, radius));
        CHECK(effect.factor({hubs_m[i][0], hubs_m[i][1], radius}) == Approx(i == 2 ? 16.0 / 15 : 1).epsilon(1e-9));
    }
}

TEST_CASE("Of a quadrotor and a hexarotor each image counts as far as both discs are over the surface") {
    test::Random random(3);
    for (const std::size_t rotors : {std::size_t{4}, std::size_t{6}}) {
        const std::vector<Vector3> body_m = ring(static_cast<int>(rotors));
        const int coverages = rotors == 4 ? 81 : 729;
        for (int number = 0; number < coverages; ++number) {
            const std::vector<double> share = coverage(number, rotors);
            const double heading = random.uniform(-3, 3);
            const double zeta = random.uniform(0.6, 2.5);
            std::vector<Vector3> hubs_m;
            std::vector<Obstacle> plates;
            for (std::size_t i = 0; i < rotors; ++i) {
                hubs_m.push_back(turned(body_m[i], heading));
                if (share[i] > 0) {
                    plates.push_back(plate_under(hubs_m[i], share[i] < 1));
                }
            }
            const auto scene = scene_of(plates);
            const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(rotors) - 1));
            const RotorNeighbours neighbours = neighbours_of(body_m, i, radius, heading);
            const DirectEffect rotor(scene, with_ground(EffectModel::multirotor_images), radius, neighbours);
            CAPTURE(rotors, number, i, zeta);
            REQUIRE(rotor.factor({hubs_m[i][0], hubs_m[i][1], zeta * radius}) ==
                    Approx(factor_by_hand(hubs_m, i, share, zeta)).epsilon(1e-6));

            // The fountain is as strong as the mean coverage.
            const SurfaceEffect body = EffectModel::multirotor_body;
            const DirectEffect fountain =
                DirectEffect::fountain(scene, with_ground(EffectModel::multirotor_body), radius, neighbours);
            double mean_share = 0;
            for (const double s : share) {
                mean_share += s / static_cast<double>(rotors);
            }
            const double whole = formula_factor(body, zeta, neighbours);
            const double images = formula_factor(EffectModel::multirotor_images, zeta, neighbours);
            REQUIRE(fountain.factor({0, 0, zeta * radius}) ==
                    Approx(1 + mean_share * (std::min(whole, 2.0) - std::min(images, 2.0))).epsilon(1e-6));
        }
    }
}

TEST_CASE("Over a wide floor and under a wide ceiling the images act as their formula says") {
    const std::vector<Vector3> hubs_m = ring(6);
    AeroSettings settings = with_ground(EffectModel::multirotor_images);
    settings.ceiling = EffectModel::multirotor_images;
    const RotorNeighbours neighbours = neighbours_of(hubs_m, 1, radius);
    const DirectEffect effect(
        scene_of({{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}}, {"roof", Box{{40, 40, 1}}, {0, 0, 3.5}, {}}}),
        settings, radius, neighbours);
    for (double z = 0.02; z < 2.99; z += 0.03) {
        const DirectEffect::Factors factors = effect.factors({hubs_m[1][0], hubs_m[1][1], z});
        const auto formula = [&](double gap_m) {
            return std::min(2.0, formula_factor(EffectModel::multirotor_images, gap_m / radius, neighbours));
        };
        REQUIRE(factors.ground == Approx(formula(z)).epsilon(1e-9));
        REQUIRE(factors.ceiling == Approx(formula(3 - z)).epsilon(1e-9));
        REQUIRE(factors.total == Approx(std::min(2.0, factors.ground + factors.ceiling - 1)).epsilon(1e-12));
    }
}

TEST_CASE("Moving, turning and mirroring scene and vehicle together changes no rotor's factor") {
    test::Random random(8);
    const std::vector<Vector3> body_m = ring(4);
    int felt = 0;
    for (int scene = 0; scene < 200; ++scene) {
        const std::vector<Obstacle> here = test::any_obstacles(random, 3, {0.8, 0.8, 1});
        const double turn = random.uniform(-3, 3);
        const double heading = random.uniform(-3, 3);
        const Vector3 shift = test::any_point(random, {9, 9, 9});
        const auto moved = [&](const Vector3& p) {
            const Vector3 t = turned(p, turn);
            return Vector3{t[0] + shift[0], t[1] + shift[1], t[2] + shift[2]};
        };
        std::vector<Obstacle> there = here;
        for (Obstacle& obstacle : there) {
            obstacle.center_world_m = moved(obstacle.center_world_m);
            obstacle.rpy_rad[2] += turn;
        }
        const auto i = static_cast<std::size_t>(random.integer(0, 3));
        const AeroSettings settings = with_ground(EffectModel::multirotor_images);
        const DirectEffect first(scene_of(here), settings, radius, neighbours_of(body_m, i, radius, heading));
        const DirectEffect second(scene_of(there), settings, radius, neighbours_of(body_m, i, radius, heading + turn));
        const Vector3 hub_m = test::any_point(random, {0.6, 0.6, 0.8});
        if (first.is_flyable(hub_m)) {
            REQUIRE(second.factor(moved(hub_m)) == Approx(first.factor(hub_m)).margin(1e-3));
            felt += first.factor(hub_m) > 1.01;
        }
    }
    CHECK(felt > 30);
}

TEST_CASE("What lies behind a plate under all rotors is not felt by their images") {
    const std::vector<Vector3> hubs_m = ring(4);
    const RotorNeighbours neighbours = neighbours_of(hubs_m, 0, radius);
    const AeroSettings settings = with_ground(EffectModel::multirotor_images);
    std::vector<Obstacle> obstacles{{"table", Box{{2, 2, 0.1}}, {0, 0, 1}, {}}};
    const DirectEffect alone(scene_of(obstacles), settings, radius, neighbours);
    obstacles.push_back({"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}});
    obstacles.push_back({"ball", Sphere{0.3}, {0.1, 0, 0.5}, {}});
    const DirectEffect with_more(scene_of(obstacles), settings, radius, neighbours);
    for (const double z : {1.12, 1.2, 1.5, 3.0}) {
        CHECK(with_more.factor({0.2, -0.3, z}) == alone.factor({0.2, -0.3, z}));
    }
}

TEST_CASE("Maps of images and fountains are within 0.01 of the direct effect") {
    test::Random random(17);
    for (int scene = 0; scene < test::repetitions(2, 6); ++scene) {
        const std::vector<Vector3> body_m = ring(scene % 2 == 0 ? 4 : 6);
        const double heading = random.uniform(-3, 3);
        AeroSettings settings = with_ground(EffectModel::multirotor_images);
        settings.ceiling = scene % 3 == 0 ? EffectModel::multirotor_images : EffectModel::sanchez_cuevas;
        settings.grid_m = 0.1;
        const auto obstacles = scene_of(test::any_obstacles(random, 6, {2, 0.6, 1.5}));
        const RotorNeighbours neighbours = neighbours_of(body_m, 0, radius, heading);
        const auto rotor = std::make_shared<const DirectEffect>(obstacles, settings, radius, neighbours);
        settings.ground = EffectModel::multirotor_body;
        const auto fountain =
            std::make_shared<const DirectEffect>(DirectEffect::fountain(obstacles, settings, radius, neighbours));
        const AeroMap map({{rotor, body_m[0][1]}, {fountain, 0}}, PlaneOfMotion({0.1, 0.2, 0.3}, heading),
                          {-2, 2, -1.5, 1.5});
        test::MapComparison found{map};
        for (int i = 0; i < 80000; ++i) {
            const auto layer = static_cast<std::size_t>(i % 2);
            found.look(layer, random.uniform(-2, 2), random.uniform(-1.5, 1.5));
        }
        CAPTURE(scene, heading, found.worst, found.points);
        CHECK(found.points > 40000);
        CHECK(found.worst <= 0.01);
    }
}
