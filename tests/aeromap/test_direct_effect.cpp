#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/error_of.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::effect_of;
using test::scene_of;

namespace {

constexpr double radius = 0.2;
const Obstacle floor_slab{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}};

Obstacle roof_at(double z) {
    return {"roof", Box{{40, 40, 1}}, {0, 0, z + 0.5}, {}};
}

std::shared_ptr<const FactorGrid> grid_of(const FactorGridParts& parts) {
    return std::make_shared<const FactorGrid>(parts);
}

}  // namespace

TEST_CASE("Over a wide floor the model itself acts, and falls with distance to 1") {
    const AeroSettings settings;
    const DirectEffect effect = effect_of({floor_slab}, settings);
    double last = 2;
    for (double z = 0.01; z < 20; z += 0.01) {
        const double factor = effect.factor({1, 2, z});
        REQUIRE(factor == EffectCurve(settings.ground, settings.max_factor)(z / radius));
        REQUIRE(factor <= last);
        last = factor;
    }
    CHECK(effect.factor({0, 0, 1000 * radius}) == Approx(1).margin(1e-6));
    CHECK(effect.factor({100, 0, 0.1}) == 1);
}

TEST_CASE("An obstacle behind another changes nothing") {
    const std::vector<Obstacle> shade{{"table", Box{{2, 2, 0.1}}, {0, 0, 1}, {}}};
    std::vector<Obstacle> both = shade;
    both.push_back(floor_slab);
    both.push_back({"ball", Sphere{0.3}, {0.1, 0, 0.5}, {}});
    both.push_back({"rod", Cylinder{0.05, 1, {1, 1, 0.2}}, {0, 0.1, 0.7}, {}});
    const DirectEffect alone = effect_of(shade);
    const DirectEffect with_more = effect_of(both);
    for (const double z : {1.12, 1.2, 1.5, 3.0}) {
        CHECK(with_more.factor({0.2, -0.3, z}) == alone.factor({0.2, -0.3, z}));
    }
}

TEST_CASE("Effects from below and above add up to the cap") {
    const AeroSettings settings;
    const DirectEffect effect(scene_of({floor_slab, roof_at(0.5)}), settings, radius);
    const double below = EffectCurve(settings.ground, 2)(0.3 / radius);
    const double above = EffectCurve(settings.ceiling, 2)(0.2 / radius);
    const DirectEffect::Factors factors = effect.factors({0, 0, 0.3});
    CHECK(factors.ground == below);
    CHECK(factors.ceiling == above);
    CHECK(factors.total == Approx(below + above - 1).epsilon(1e-14));
    const DirectEffect tight(scene_of({floor_slab, roof_at(0.14)}), settings, radius);
    CHECK(tight.factor({0, 0, 0.075}) == 2);
}

TEST_CASE("A vertical wall beside the disc has no effect, nor has a side without a model") {
    const DirectEffect effect(scene_of({{"wall", Box{{1, 40, 40}}, {1, 0, 0}, {}}}), {}, radius);
    CHECK(effect.factor({0.5 - radius, 0, 0}) == 1);
    CHECK(effect.factor({0.4 - radius, 3, 1}) == 1);
    CHECK(effect.factor({0.45 - radius, 3, -2}) == 1);
    AeroSettings settings;
    settings.ground.model = EffectModel::none;
    const DirectEffect from_above(scene_of({floor_slab, roof_at(0.5)}), settings, radius);
    CHECK(from_above.factors({0, 0, 0.2}).ground == 1);
    CHECK(from_above.factors({0, 0, 0.2}).ceiling > 1);
}

TEST_CASE("Moving and turning scene and rotor together changes nothing") {
    test::Random random(5);
    for (int i = 0; i < 300; ++i) {
        const std::vector<Obstacle> here = test::any_obstacles(random, 3, {0.8, 0.8, 1});
        const double turn = random.uniform(-3, 3);
        const Vector3 shift = test::any_point(random, {9, 9, 9});
        const auto moved = [&](const Vector3& p) {
            return Vector3{shift[0] + std::cos(turn) * p[0] - std::sin(turn) * p[1],
                           shift[1] + std::sin(turn) * p[0] + std::cos(turn) * p[1], shift[2] + p[2]};
        };
        std::vector<Obstacle> there = here;
        for (Obstacle& obstacle : there) {
            obstacle.center_world_m = moved(obstacle.center_world_m);
            obstacle.rpy_rad[2] += turn;
        }
        const Vector3 hub = test::any_point(random, {0.5, 0.5, 0.6});
        const DirectEffect first(scene_of(here), {}, radius);
        if (first.is_flyable(hub)) {
            const DirectEffect second(scene_of(there), {}, radius);
            REQUIRE(second.factor(moved(hub)) == Approx(first.factor(hub)).margin(1e-3));
        }
    }
}

TEST_CASE("The flyable area keeps the least distance from every obstacle") {
    AeroSettings settings;
    settings.min_distance_radii = 0.5;
    const DirectEffect effect = effect_of({floor_slab}, settings);
    CHECK(effect.is_flyable({0, 0, 0.1001}));
    CHECK(!effect.is_flyable({0, 0, 0.0999}));
    CHECK(effect.is_flyable({20.1001 + radius, 0, -0.5}));
    CHECK(!effect.is_flyable({20.0999 + radius, 0, -0.5}));
    CHECK(!effect.is_flyable({std::numeric_limits<double>::quiet_NaN(), 0, 3}));
}

TEST_CASE("A position that is not finite has the factor 1") {
    const DirectEffect effect(scene_of(test::bridge()), {}, radius);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity}) {
        CHECK(effect.factor({bad, 0, 1}) == 1);
        CHECK(effect.factor({0, bad, 1}) == 1);
        CHECK(effect.factor({0, 0, bad}) == 1);
    }
}

TEST_CASE("Settings out of their range and a table without values lead to every error") {
    AeroSettings settings;
    settings.ceiling = EffectModel::table;
    CHECK_THROWS_AS(DirectEffect(scene_of({}), settings, radius), InputError);
    settings.ceiling = EffectModel::sanchez_cuevas;
    settings.max_factor = 0.5;
    settings.min_distance_radii = -1;
    settings.ceiling.parameters[0] = 0;
    settings.ground = EffectModel::he;
    settings.ground.parameters[1] = std::numeric_limits<double>::quiet_NaN();
    settings.tilt_loss = {-1, std::numeric_limits<double>::infinity()};
    CHECK(test::errors_of([&] { return DirectEffect(scene_of({}), settings, 0); }).size() == 7);
}

TEST_CASE("The fountain is averaged over the discs of all rotors") {
    AeroSettings settings;
    settings.ground = EffectModel::multirotor_body;
    const RotorNeighbours quadrotor = square_quadrotor(2.6);
    // A table that ends under the vehicle: two of four rotors are over it.
    const auto scene = scene_of({floor_slab, {"table", Box{{2, 4, 0.1}}, {1, 0, 0.45}, {}}});
    const DirectEffect fountain = DirectEffect::fountain(scene, settings, radius, quadrotor);
    const EffectCurve curve = EffectCurve::fountain(settings.ground, settings.max_factor, quadrotor);
    CHECK(fountain.column_radius_m() == Approx(radius * (1 + 2.6 / std::sqrt(2.0))).epsilon(1e-8));
    CHECK(fountain.factor({0, 0, 0.7}) == Approx(0.5 * (curve(0.2 / radius) + curve(0.7 / radius))).epsilon(1e-10));
    CHECK(fountain.factors({0, 0, 0.7}).ceiling == 1);
    CHECK(fountain.is_flyable({1, 0, 0.45}));
    CHECK(fountain.factor({0.13, 0.2, 100}) == Approx(1).margin(1e-3));
}

TEST_CASE("A table over wall distance sees walls, not the ground") {
    AeroSettings settings;
    settings.ground = EffectModel::table;
    settings.ground.table = std::make_shared<const EffectTable>(
        std::vector<double>{0.5, 1, 2}, std::vector<double>{1, 3}, std::vector<double>{1.3, 1.2, 1.1, 0.9, 0.95, 1});
    const auto with_wall = scene_of({floor_slab, {"wall", Box{{1, 40, 40}}, {2, 0, 0}, {}}});  // its face at x = 1.5
    const DirectEffect effect(with_wall, settings, radius);
    const EffectTable& table = *settings.ground.table;
    for (const double d : {1.0, 1.4, 2.0, 2.9, 3.0, 5.0}) {
        for (const double zeta : {0.6, 0.9, 1.0, 1.3, 1.9}) {
            CAPTURE(d, zeta);
            CHECK(effect.factor({1.5 - d * radius, 0, zeta * radius}) == Approx(table.at(d)(zeta)).epsilon(1e-6));
        }
    }
    CHECK(effect.factor({1.5 - 1.2 * radius, 0, 1.2 * radius}) != Approx(effect.factor({0, 0, 1.2 * radius})));
    settings.ground.d_over_r = 1.4;  // now a constant, for example the spacing of a tandem
    CHECK(DirectEffect(with_wall, settings, radius).factor({-3, 0, radius}) == Approx(table.at(1.4)(1)).epsilon(1e-9));
}

TEST_CASE("A given map takes the place of the models where it reaches") {
    // K = 1 + 0.1 x + 0.2 z on a coarse planar grid: linear, so that the interpolation is exact.
    FactorGridParts parts;
    parts.x = {-1, 1, 5};
    parts.z = {0, 2, 9};
    GridField factor{"factor", {}};
    for (std::size_t k = 0; k < parts.z.count; ++k) {
        for (std::size_t i = 0; i < parts.x.count; ++i) {
            factor.values.push_back(1 + 0.1 * parts.x.at(i) + 0.2 * parts.z.at(k));
        }
    }
    parts.fields.push_back(factor);
    AeroSettings settings;
    settings.map = grid_of(parts);
    const DirectEffect effect = effect_of({floor_slab}, settings);
    CHECK(effect.factor({0.3, 0.7, 0.9}) == Approx(1.21));
    CHECK(std::isnan(effect.factors({0.3, 0, 0.9}).ground));
    CHECK(effect.is_flyable({0.3, 0, 0.9}));
    CHECK(!effect.is_flyable({1.3, 0, 0.9}));
    CHECK(!effect.is_flyable({0.3, 0, 0.01}));
    CHECK(effect.factor({1.3, 0, 0.9}) == 1);
    const AeroMap map(test::layers(std::make_shared<const DirectEffect>(effect), {0}), {}, {-1, 1, 0.1, 2});
    for (const double x : {-0.9, -0.33, 0.1, 0.77}) {
        CHECK(map.factor(0, x, 1.3) == Approx(1 + 0.1 * x + 0.26).margin(1e-6));
    }
}

TEST_CASE("A map says as the direct effect where one may fly on a given map") {
    // The given map is smaller than the extent, and its nodes are those of some cells of the map.
    test::Random random(32);
    for (const bool has_flags : {true, false}) {
        for (const bool is_turned : {true, false}) {
            FactorGridParts parts;
            const PlaneOfMotion plane({0.3, -0.2, 0.1}, 0.7);
            // A volume may stand athwart the plane.
            parts.frame = is_turned ? PlaneOfMotion({0, 0, 0}, 0.1) : plane;
            parts.x = {-1, 1, 21};
            parts.z = {0, 2, 21};
            parts.y = is_turned ? GridAxis{-2, 2, 9} : GridAxis{};
            const std::size_t nodes = parts.x.count * parts.y.count * parts.z.count;
            parts.fields = {{"factor", std::vector<double>(nodes, 1.25)}};
            if (has_flags) {
                GridField flags{"flyable", std::vector<double>(nodes, 1)};
                for (std::size_t n = 0; n < nodes / 40; ++n) {
                    flags.values[static_cast<std::size_t>(random.integer(0, static_cast<int>(nodes) - 1))] = 0;
                }
                parts.fields.push_back(flags);
            }
            AeroSettings settings;
            settings.map = grid_of(parts);
            const auto effect = test::effect_in({floor_slab}, radius, settings);
            const AeroMap map(test::layers(effect, {0.2}), plane, {-1.2, 1.3, -0.1, 2.2});
            int flyable = 0;
            for (int n = 0; n < 20000; ++n) {
                // Every other point is a node of the grid.
                const double x = n % 2 == 0 ? random.uniform(-1.3, 1.4) : 0.1 * random.integer(-12, 12);
                const double z = n % 2 == 0 ? random.uniform(-0.2, 2.3) : 0.1 * random.integer(-1, 22);
                const bool is_flyable = effect->is_flyable(plane.to_world(x, 0.2, z));
                flyable += is_flyable ? 1 : 0;
                REQUIRE(map.is_flyable(0, x, z) == is_flyable);
            }
            CHECK(flyable > 3000);
            CHECK(flyable < 17000);
        }
    }
}

TEST_CASE("Disabled effects leave the free air everywhere and heed no given map") {
    AeroSettings settings;
    settings.enabled = false;
    const DirectEffect over_floor = effect_of({floor_slab}, settings);
    CHECK(over_floor.factor({0, 0, 0.1}) == 1);
    CHECK(over_floor.is_flyable({0, 0, 0.01}));
    FactorGridParts parts;
    parts.x = parts.z = {0, 1, 2};
    parts.fields = {{"factor", {1, 1, 1, 1}}, {"flyable", {0, 0, 0, 0}}};
    settings.map = grid_of(parts);
    const auto effect = test::effect_in({}, radius, settings);
    CHECK(effect->is_flyable({0.5, 0, 0.5}));
    CHECK(AeroMap(test::layers(effect, {0}), {}, {0, 1, 0, 1}).is_flyable(0, 0.5, 0.5));
}

TEST_CASE("Over ground tilt counts unless one says otherwise, under a ceiling it does not") {
    CHECK(AeroSettings().tilt_loss == TiltLoss{default_ground_tilt_loss, 0});
}
