// The quadrature over the disc against closed forms and against counting rays.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/meshes.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/effects/effect_models.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::scene_of;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 0.2;

}  // namespace

TEST_CASE("The edge of a half plane covers a circular segment, whatever its direction, below and above") {
    const AeroSettings settings;
    for (int turn = 0; turn < 32; ++turn) {
        const double angle = turn < 8 ? turn * pi / 4 : 0.37 * turn;
        const Vector3 along{std::cos(angle), std::sin(angle), 0};
        // A large slab whose edge runs through the origin, its inside in the direction `along`; top at 0, bottom at -1.
        const DirectEffect effect(
            scene_of({{"", Box{{40, 60, 1}}, {20 * along[0], 20 * along[1], -0.5}, {0, 0, angle}}}), settings, radius);
        for (double s = -1.25; s <= 1.25; s += 0.0625) {
            const double inside = std::min(1.0, std::max(-1.0, s));
            const double covered = 0.5 + (std::asin(inside) + inside * std::sqrt(1 - inside * inside)) / pi;
            const double x = s * radius * along[0];
            const double y = s * radius * along[1];
            const double over = 1 + covered * (EffectCurve(settings.ground, 2)(0.8) - 1);
            const double under = 1 + covered * (EffectCurve(settings.ceiling, 2)(0.8) - 1);
            REQUIRE(effect.factors({x, y, 0.8 * radius}).ground == Approx(over).epsilon(0).margin(1e-11));
            REQUIRE(effect.factors({x, y, -1 - 0.8 * radius}).ceiling == Approx(under).epsilon(0).margin(1e-11));
            // Where the rotor plane cuts the slab the covered part counts as touching, on both sides.
            REQUIRE(effect.factors({x, y, -0.5}).ground == Approx(1 + covered).epsilon(0).margin(1e-11));
            REQUIRE(effect.factors({x, y, -0.5}).ceiling == Approx(1 + covered).epsilon(0).margin(1e-11));
        }
    }
}

TEST_CASE("Level slabs beside each other count by the areas that they cover, a corner's and a strip's in closed form") {
    const AeroSettings settings;
    const EffectCurve curve(settings.ground, 2);
    const double near = curve(0.5) - 1;
    const double far = curve(1.5) - 1;
    for (const double angle : {0.0, 0.3, pi / 4, 2.9}) {
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        const auto turned = [&](double x, double y, double z) { return Vector3{c * x - s * y, s * x + c * y, z}; };
        // A quarter of the plane at one height, and beside it, sharing an edge, a strip of the half plane at another.
        const double width = 0.6 * radius;
        const DirectEffect effect(
            scene_of({{"corner", Box{{20, 20, 1}}, turned(10, 10, -0.5), {0, 0, angle}},
                      {"strip", Box{{width, 40, 1}}, turned(-0.5 * width, 0, -0.5 - radius), {0, 0, angle}}}),
            settings, radius);
        const double strip = (std::asin(0.6) + 0.6 * std::sqrt(1 - 0.36)) / pi;  // between the chords 0 and 0.6 R
        const Vector3 hub = turned(0, 0, 0.5 * radius);
        REQUIRE(effect.factors(hub).ground == Approx(1 + near / 4 + far * strip).epsilon(0).margin(1e-11));
    }
}

TEST_CASE("A level triangle without width covers nothing, in whatever direction it lies") {
    for (const Vector3& last : {Vector3{0.3, 0.9, 0}, Vector3{0.7, 2.1, 0}, Vector3{-0.3, -0.9, 0}}) {
        const Mesh mesh =
            test::mesh_of({{0, 0, 0}, {0.1, 0.3, 0}, last, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}}, {{0, 1, 2}, {3, 4, 5}});
        const DirectEffect effect(scene_of({{"sheet", mesh, {0, 0, 0}}}), {}, 0.15);
        REQUIRE(effect.factors({0.15, 0.25, 0.1}).ground == Approx(1).epsilon(0).margin(1e-9));
        REQUIRE(effect.factors({5.3, 5.3, 0.1}).ground > 1.01);  // the other triangle is there
    }
}

TEST_CASE("Over a wide slope Cheeseman and Bennett's formula has a closed average") {
    test::Random random(8);
    // The average of 1 / (a + s u) over the unit disc.
    const auto mean_inverse = [](double a, double s) { return 2 * (a - std::sqrt(a * a - s * s)) / (s * s); };
    for (int i = 0; i < 200; ++i) {
        const double pitch = random.uniform(0.05, 0.7);
        const double yaw = random.uniform(-pi, pi);
        // Hidden below the slope: a sphere that must not matter.
        const DirectEffect effect(
            scene_of({{"slope", Box{{20, 20, 2}}, {}, {0, pitch, yaw}}, {"", Sphere{0.3}, {0, 0, -1.5}, {}}}), {},
            radius);
        const double x = random.uniform(-3, 3);
        const double y = random.uniform(-3, 3);
        const double top = 1 / std::cos(pitch) - std::tan(pitch) * (x * std::cos(yaw) + y * std::sin(yaw));
        const double s = radius * std::tan(pitch);
        const double gap = s + random.uniform(0.36, 4) * radius;  // K = 2 at 0.354 R
        const double c = radius / 4;
        const double expected = 1 + 0.5 * c * (mean_inverse(gap - c, s) - mean_inverse(gap + c, s));
        REQUIRE(effect.factors({x, y, top + gap}).ground == Approx(expected).epsilon(0).margin(1e-7));
        // Across the cap, and under the slope.
        const Vector3 near{x, y, top + s + 0.25 * radius};
        const Vector3 under{x, y, top - 2 / std::cos(pitch) - gap};
        if (i % 20 == 0) {
            CHECK(effect.factors(near).ground == Approx(test::by_rays(effect, near, 400).ground).margin(1e-3));
            CHECK(effect.factors(under).ceiling == Approx(test::by_rays(effect, under, 400).ceiling).margin(1e-3));
        }
    }
}

TEST_CASE("A pipe under the rotor agrees with a million rays") {
    const AeroSettings settings;
    for (const double pipe_radius : {0.03, 0.1, 0.25}) {
        const DirectEffect effect(scene_of({{"", Cylinder{pipe_radius, 6, {1, 2, 0}}, {}, {}}}), settings, radius);
        for (const double sideways : {0.0, 0.07, 0.21}) {
            const Vector3 hub{sideways, 0, pipe_radius + 0.4 * radius};
            const Vector3 under{sideways, 0, -hub[2]};
            CHECK(effect.factors(hub).ground == Approx(test::by_rays(effect, hub).ground).margin(1e-3));
            CHECK(effect.factors(under).ceiling == Approx(test::by_rays(effect, under).ceiling).margin(1e-3));
        }
    }
}

TEST_CASE("Over a level pipe and a ball the average is an integral over one variable, across the cap too") {
    const AeroSettings settings;
    const EffectCurve curve(settings.ground, settings.max_factor);
    // Over the pipe's axis the gap depends on the distance from it, over the ball's centre on that from the centre.
    const auto average = [&curve](double body_radius, double gap, bool is_ball) {
        constexpr int steps = 100000;
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double w = radius * (i + 0.5) / steps;
            const double weight = is_ball ? 2 * pi * w : 4 * std::sqrt(radius * radius - w * w);
            const double below = body_radius * body_radius - w * w;
            sum += below < 0 ? 0 : weight * (curve((gap + body_radius - std::sqrt(below)) / radius) - 1);
        }
        return 1 + sum * (radius / steps) / (pi * radius * radius);
    };
    for (const double body_radius : {0.05, 0.15, 0.21, 0.5, 2.0}) {
        for (const double yaw : {0.0, 0.3, 1.1}) {
            const DirectEffect pipe(scene_of({{"", Cylinder{body_radius, 9, {1, 0, 0}}, {}, {0, 0, yaw}}}), settings,
                                    radius);
            const DirectEffect ball(scene_of({{"", Sphere{body_radius}, {}, {}}}), settings, radius);
            for (double gap = 0.3 * radius; gap < 3 * radius; gap *= 1.07) {
                CAPTURE(body_radius, yaw, gap);
                const Vector3 hub{0, 0, body_radius + gap};
                const double on_pipe = average(body_radius, gap, false);
                REQUIRE(pipe.factors(hub).ground == Approx(on_pipe).epsilon(0).margin(1.5e-3));
                const double on_ball = average(body_radius, gap, true);
                REQUIRE(ball.factors(hub).ground == Approx(on_ball).epsilon(0).margin(2e-3));
            }
        }
    }
}

TEST_CASE("Whichever of a tilted block's faces lie over one chord, each counts as far as it reaches") {
    test::Random random(23);
    int compared = 0;
    double worst = 0;
    while (compared < 800) {
        const Obstacle block{"",
                             Box{{random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), random.uniform(0.1, 0.5)}},
                             {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0},
                             {random.uniform(-pi, pi), random.uniform(-pi, pi), random.uniform(-pi, pi)}};
        const DirectEffect effect(scene_of({block}), {}, radius);
        const Vector3 hub{0, 0, random.uniform(0.1, 0.6)};
        if (!effect.is_flyable(hub) || effect.factors(hub).ground < 1.01) {
            continue;
        }
        worst = std::max(worst, std::abs(effect.factors(hub).ground - test::by_rays(effect, hub, 150).ground));
        ++compared;
    }
    CHECK(worst < 3e-3);  // of which the rays' own error is half
}

TEST_CASE("Slopes that cross each other over the disc are seen as far as each is first") {
    // Two wide planes that meet in a valley along y, gap c - s |x|: an integral over one variable again.
    const AeroSettings settings;
    const EffectCurve curve(settings.ground, settings.max_factor);
    for (const double pitch : {0.1, 0.4, 0.8}) {
        const double s = std::tan(pitch);
        const double top = 1 / std::cos(pitch);
        const DirectEffect effect(
            scene_of({{"", Box{{20, 20, 2}}, {}, {0, pitch, 0}}, {"", Box{{20, 20, 2}}, {}, {0, -pitch, 0}}}), settings,
            radius);
        for (double gap = 0.3 * radius; gap < 3 * radius; gap *= 1.1) {
            constexpr int steps = 20000;
            double sum = 0;
            for (int i = 0; i < steps; ++i) {
                const double w = radius * (i + 0.5) / steps;
                sum += 4 * std::sqrt(radius * radius - w * w) * curve((gap + s * (radius - w)) / radius);
            }
            const double expected = sum * (radius / steps) / (pi * radius * radius);
            CAPTURE(pitch, gap);
            REQUIRE(effect.factors({0, 0, top + gap + s * radius}).ground == Approx(expected).epsilon(0).margin(1e-3));
        }
    }
}

TEST_CASE("Anywhere flyable among random obstacles the effect agrees with counted rays") {
    test::Random random(3);
    int compared = 0;
    double worst = 0;
    while (compared < 150) {
        const std::vector<Obstacle> obstacles = test::any_obstacles(random, 4, {0.8, 0.8, 1});
        const DirectEffect effect(scene_of(obstacles), {}, random.uniform(0.08, 0.2));
        const Vector3 hub = test::any_point(random, {0.5, 0.5, 0.6});
        const DirectEffect::Factors factors = effect.factors(hub);
        if (factors.total < 1.01 || !effect.is_flyable(hub)) {
            continue;
        }
        const DirectEffect::Factors counted = test::by_rays(effect, hub, 400);
        worst =
            std::max({worst, std::abs(factors.ground - counted.ground), std::abs(factors.ceiling - counted.ceiling)});
        ++compared;
    }
    CHECK(worst < 2e-3);
}

TEST_CASE("Many obstacles over one disc are all counted") {
    std::vector<Obstacle> lattice;
    for (int i = 0; i < 60; ++i) {
        lattice.push_back({"", Box{{0.003, 2, 0.1}}, {0.006 * (i - 30), 0, -0.2 - 0.001 * i}, {}});
        lattice.push_back({"", Cylinder{0.002, 2, {1, 0, 0}}, {0, 0.006 * (i - 30), 0.3}, {}});
    }
    const DirectEffect effect(scene_of(lattice), {}, radius);
    const DirectEffect::Factors counted = test::by_rays(effect, {0.001, 0, 0});
    CHECK(effect.factors({0.001, 0, 0}).ground == Approx(counted.ground).margin(3e-3));
    CHECK(effect.factors({0.001, 0, 0}).ceiling == Approx(counted.ceiling).margin(3e-3));
}
