#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/effects/pipe_table.hpp"
#include "scenes.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double radius = 0.2;
constexpr double reach = 0.3;

DirectEffect walls_of(std::vector<Obstacle> obstacles, double heading_rad = 0) {
    AeroSettings settings;
    settings.wall = {0.01, 0.03, 0.7};
    return DirectEffect::walls(scene_of(std::move(obstacles)), settings, radius, reach, heading_rad);
}

/// A wall whose face is at x, turned about the origin.
Obstacle wall_at(double x, double turn_rad = 0) {
    const double middle = x + (x > 0 ? 0.5 : -0.5);
    return {"wall", Box{{1, 40, 6}}, {middle * std::cos(turn_rad), middle * std::sin(turn_rad), 3}, {0, 0, turn_rad}};
}

}  // namespace

TEST_CASE("A wall ahead is near by exp of the gap to the nearest rotor's edge, one behind by minus that") {
    for (const double x : {0.6, 1.0, 2.0}) {
        const double expected = std::exp(-(x - reach - radius) / (0.7 * radius));
        CHECK(walls_of({wall_at(x)}).factor({0, 0, 1}) == Approx(1 + expected).margin(1e-5));
        CHECK(walls_of({wall_at(-x)}).factor({0, 0, 1}) == Approx(1 - expected).margin(1e-5));
    }
    CHECK(walls_of({wall_at(0.4)}).factor({0, 0, 1}) == Approx(2).margin(1e-5));  // touched
    CHECK(walls_of({wall_at(0.6)}).factor({0, 0, 7}) == 1);                       // over its top
    CHECK(walls_of({}).factor({0, 0, 1}) == 1);
}

TEST_CASE("Of a wall aslant only the part along the plane of motion counts") {
    const double expected = std::exp(-(1.0 - reach - radius) / (0.7 * radius));
    for (const double turn_rad : {0.4, 1.2, std::acos(-1.0) / 2}) {
        CHECK(walls_of({wall_at(1, turn_rad)}).factor({0, 0, 1}) ==
              Approx(1 + std::cos(turn_rad) * expected).margin(1e-5));
        CHECK(walls_of({wall_at(1, turn_rad)}, turn_rad).factor({0, 0, 1}) == Approx(1 + expected).margin(1e-5));
    }
}

TEST_CASE("Midway between two walls they cancel, without a jump") {
    const DirectEffect both = walls_of({wall_at(0.8), wall_at(-0.8)});
    CHECK(both.factor({0, 0, 1}) == Approx(1).margin(1e-6));
    CHECK(both.factor({0.1, 0, 1}) > 1);
    double last = both.factor({-0.05, 0, 1});
    for (double x = -0.05; x < 0.05; x += 0.001) {
        const double here = both.factor({x, 0, 1});
        CHECK(std::abs(here - last) < 0.02);
        last = here;
    }
}

TEST_CASE("The map of walls is within 0.01 of them") {
    AeroSettings settings;
    settings.wall = {0, 0.03, 0.7};
    const auto effect = std::make_shared<const DirectEffect>(DirectEffect::walls(
        scene_of({wall_at(1), {"post", Cylinder{0.3, 8, {0, 0, 1}}, {-1.5, 0.5, 2}, {}}}), settings, radius, reach, 0));
    const AeroMap map({{effect, 0}}, {}, {-4, 3, 0.2, 2.5});
    double worst = 0;
    for (int i = 0; i < 120; ++i) {
        for (int k = 0; k < 12; ++k) {
            const double x = -4 + 7 * (i + 0.37) / 120;
            const double z = 0.2 + 2.3 * (k + 0.61) / 12;
            worst = std::max(worst, std::abs(map.factor(0, x, z) - effect->factor({x, 0, z})));
            REQUIRE(map.is_flyable(0, x, z));
        }
    }
    CHECK(worst <= 0.01);
}

TEST_CASE("Over the axis of a pipe a rotor feels what the pipe's table says, and nothing is averaged twice") {
    const EffectTable measured({0.4, 0.7, 1.2, 2}, {}, {1.25, 1.15, 1.04, 1});
    const double pipe_radii = 0.5;
    AeroSettings settings;
    settings.ground = EffectModel::table;
    settings.ground.table = std::make_shared<const EffectTable>(points_of_pipe(measured, pipe_radii));
    settings.ground.pipe_radii = pipe_radii;
    const DirectEffect over(scene_of({{"pipe", Cylinder{pipe_radii * radius, 20, {1, 0, 0}}, {0, 0, 0}, {}}}), settings,
                            radius);
    for (const double zeta : {0.4, 0.7, 1.2, 2.0}) {
        CHECK(over.factor({0, 0, pipe_radii * radius + zeta * radius}) == Approx(measured.at()(zeta)).margin(2e-3));
    }
    CHECK(over.factor({0, radius * 1.6, pipe_radii * radius + 0.4 * radius}) == 1);  // beside it
}
