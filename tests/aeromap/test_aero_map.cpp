#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/hard_places.hpp"
#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/effects/effect_table.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::MapComparison;

namespace {

/// Map against direct evaluation at random flyable positions, most of them where the effect is felt.
MapComparison compare(const AeroMap& map, int points, unsigned seed, int least_felt = 0) {
    test::Random random(seed);
    MapComparison result{map};
    int felt = 0;
    const Bounds& extent = map.extent();
    for (long tries = 0; result.points < points && tries < 400L * points; ++tries) {
        const double x = random.uniform(extent.x_low_m, extent.x_high_m);
        const double z = random.uniform(extent.z_low_m, extent.z_high_m);
        const auto layer = static_cast<std::size_t>(random.integer(0, static_cast<int>(map.layers().size()) - 1));
        const bool wants_effect = tries % 40 != 0;
        if (wants_effect && map.factor(layer, x, z) < 1.05) {
            continue;
        }
        const DirectEffect& direct = *map.layers()[layer].effect;
        const Vector3 hub = map.plane().to_world(x, map.layers()[layer].lateral_m, z);
        REQUIRE(map.is_flyable(layer, x, z) == direct.is_flyable(hub));
        felt += result.look(layer, x, z) && wants_effect;
    }
    CHECK(felt >= least_felt);
    return result;
}

std::shared_ptr<const DirectEffect> effect_in(std::vector<Obstacle> obstacles, double radius, double grid_m = 0.05) {
    AeroSettings settings;
    settings.grid_m = grid_m;
    return test::effect_in(std::move(obstacles), radius, settings);
}

std::vector<Obstacle> random_obstacles(test::Random& random, int count) {
    return test::any_obstacles(random, count, {2, 0.6, 1.5});
}

}  // namespace

TEST_CASE("A map of random scenes is within 0.01 of the direct effect wherever one may fly") {
    test::Random random(11);
    for (int scene = 0; scene < 8; ++scene) {
        const double radius = random.uniform(0.06, 0.25);
        const double grid_m = scene % 4 == 3 ? 0.3 : 0.05;
        const AeroMap map(test::layers(effect_in(random_obstacles(random, 6), radius, grid_m), {-0.2, 0.1}),
                          PlaneOfMotion({0.1, 0.2, 0.3}, random.uniform(-3, 3)), {-2, 2, -1.5, 1.5});
        const MapComparison found = compare(map, 20000, 100U + static_cast<unsigned>(scene));
        CAPTURE(scene, radius, grid_m, found.worst);
        CHECK(found.points == 20000);
        CHECK(found.worst <= 0.01);
    }
}

TEST_CASE("A map that follows a change of its scene is that of the new scene to the last bit") {
    test::Random random(17);
    int untouched = 0;
    double kept_share = 0;
    for (int scene = 0; scene < 24; ++scene) {
        const double radius = random.uniform(0.06, 0.25);
        const std::vector<Obstacle> all = random_obstacles(random, 7);
        std::vector<Obstacle> before(all.begin(), all.end() - 1);
        std::vector<Obstacle> after = before;
        const int kind = scene % 3;
        if (kind == 0) {  // one more
            after.push_back(all.back());
        } else if (kind == 1) {  // one moved
            after.front().center_world_m[0] += random.uniform(-0.5, 0.5);
            after.front().center_world_m[2] += 0.1;
        } else {  // one less
            after.pop_back();
        }
        const PlaneOfMotion plane({0.1, 0.2, 0.3}, random.uniform(-3, 3));
        const Bounds extent{-2, 2, -1.5, 1.5};
        const AeroMap old(test::layers(effect_in(before, radius), {-0.2, 0.1}), plane, extent);
        const auto layers = test::layers(effect_in(after, radius), {-0.2, 0.1});
        std::vector<BoundingBox> changed;
        for (const Obstacle& touched : kind == 0   ? std::vector{after.back()}
                                       : kind == 1 ? std::vector{before.front(), after.front()}
                                                   : std::vector{before.back()}) {
            changed.push_back(Scene({touched}).bounds(0));
        }
        CAPTURE(scene, radius);
        const AeroMap anew(layers, plane, extent);
        old.fill(2);
        anew.fill(2);
        const AeroMap following = old.rebuilt(layers, changed);
        kept_share += following.filled_share();
        following.fill(2);
        CHECK(following.to_bytes() == anew.to_bytes());
        // Where it says that nothing is touched, nothing is another.
        constexpr double strip_m = 0.02;  // narrower than a block of cells
        for (double x_m = -2; x_m < 2 - strip_m; x_m += strip_m) {
            const Bounds part{x_m, x_m + strip_m, -1.5, 1.5};
            if (old.is_touched(changed, part)) {
                continue;
            }
            ++untouched;
            for (int i = 0; i < 100; ++i) {
                const double x = random.uniform(part.x_low_m, part.x_high_m);
                const double z = random.uniform(part.z_low_m, part.z_high_m);
                CHECK(old.factor(1, x, z) == anew.factor(1, x, z));
                CHECK(old.is_flyable(1, x, z) == anew.is_flyable(1, x, z));
            }
        }
        CHECK_FALSE(old.is_touched({}, extent));
        CHECK(old.is_touched({}, {-2.1, 0, 0, 1}));
        CHECK(old.is_touched(changed, extent));
    }
    CHECK(untouched > 24);
    CHECK(kept_share > 24 * 0.15);
}

TEST_CASE("Up to the edge of the flyable area no value of the other side is seen") {
    test::Random random(13);
    int points = 0;
    for (int scene = 0; scene < 6; ++scene) {
        const double radius = random.uniform(0.06, 0.25);
        const AeroMap map(test::layers(effect_in(random_obstacles(random, 6), radius), {0.1}),
                          PlaneOfMotion({0.1, 0.2, 0.3}, random.uniform(-3, 3)), {-2, 2, -1.5, 1.5});
        const MapView& view = map.view(0);
        const MapArrays arrays = arrays_of(map, 0, 2);
        MapComparison found{map};
        for (std::size_t cell = 0; cell < arrays.cells.size(); ++cell) {
            for (int i = 0; arrays.flyability[cell] == CellFlyability::mixed && i < 100; ++i) {
                const auto column = static_cast<double>(cell % view.columns);
                const std::size_t row = cell / view.columns;
                const double x = view.x_low_m + (column + random.uniform(0, 1)) / view.cells_per_m;
                const double z = view.z_low_m + (static_cast<double>(row) + random.uniform(0, 1)) / view.cells_per_m;
                found.look(0, x, z);
            }
        }
        CAPTURE(scene, radius, found.worst);
        CHECK(found.worst <= 0.01);
        points += found.points;
    }
    CHECK(points > 20000);
}

TEST_CASE("A map of a bridge, and one with another cap and distance, is within 0.01 of the direct effect") {
    const AeroMap map(test::layers(effect_in(test::bridge(), 0.15), {-0.18, 0.18}), {}, {-12, 12, 0, 12});
    const MapComparison found = compare(map, 40000, 21, 10000);
    CAPTURE(found.worst);
    CHECK(found.points == 40000);
    CHECK(found.worst <= 0.01);
    map.fill(2);
    CHECK(map.memory_bytes() < 64U << 20U);
    AeroSettings settings;
    settings.max_factor = 3;
    settings.min_distance_radii = 0.2;
    const auto effect_to_three = test::effect_in(
        {{"", Box{{4, 4, 1}}, {0, 0, -0.5}, {}}, {"", Cylinder{0.2, 2, {0, 1, 0}}, {0, 0, 1}, {}}}, 0.12, settings);
    const AeroMap map_to_three(test::layers(effect_to_three, {0}), {}, {-1, 1, 0, 2});
    const MapComparison to_three = compare(map_to_three, 20000, 31);
    CHECK(to_three.worst <= 0.01);
}

TEST_CASE("A map of a table with values below one and of wall distances is within 0.01 as well") {
    AeroSettings settings;
    settings.ground = EffectModel::table;
    settings.ground.table = std::make_shared<const EffectTable>(
        std::vector<double>{0.4, 0.8, 1.5, 2.5, 4}, std::vector<double>{1, 1.5, 3},
        std::vector<double>{1.4, 1.35, 1.3, 1.1, 1.12, 1.15, 0.9, 0.93, 1.02, 0.97, 0.98, 1, 1, 1, 1});
    const auto effect = test::effect_in({{"floor", Box{{6, 6, 1}}, {0, 0, -0.5}, {}},
                                         {"wall", Box{{0.5, 4, 3}}, {0.8, 0, 1.5}, {}},
                                         {"pipe", Cylinder{0.2, 2, {0, 1, 0}}, {-0.6, 0, 1}, {}}},
                                        0.15, settings);
    const AeroMap map(test::layers(effect, {0, 0.2}), {}, {-1.5, 1.5, 0, 2});
    MapComparison found{map};
    double least = 1;
    test::Random random(51);
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-1.5, 1.5);
        least = std::min(least, found.look(1, x, random.uniform(0, 2)).value_or(1));
    }
    CHECK(found.worst <= 0.01);
    CHECK(least < 0.94);
}

TEST_CASE("A map is the same to the bit for any number of threads") {
    test::Random random(12);
    const auto effect = effect_in(random_obstacles(random, 5), 0.15);
    const auto map = [&](int threads) {
        AeroMap filled(test::layers(effect, {-0.2, 0.2}), {}, {-2, 2, -1.5, 1.5});
        filled.fill(threads);
        return filled;
    };
    const AeroMap one = map(1);
    for (const int threads : {2, 5}) {
        CAPTURE(threads);
        const AeroMap other = map(threads);
        CHECK(other.memory_bytes() == one.memory_bytes());
        CHECK(other.to_bytes() == one.to_bytes());
    }
}

TEST_CASE("Obstacles beside the plane of motion change no value of a map, however many they are") {
    test::Random random(30);
    const std::vector<Obstacle> near = random_obstacles(random, 6);
    std::vector<Obstacle> all = near;
    for (int i = 0; i < 300; ++i) {
        all.push_back(
            test::any_obstacle(random, {random.uniform(-9, 9), 5 + random.uniform(0, 9), random.uniform(-2, 2)}));
    }
    const Bounds extent{-2, 2, -1.5, 1.5};
    const AeroMap alone(test::layers(effect_in(near, 0.2), {0}), {}, extent);
    const AeroMap among(test::layers(effect_in(all, 0.2), {0}), {}, extent);
    int felt = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(extent.x_low_m, extent.x_high_m);
        const double z = random.uniform(extent.z_low_m, extent.z_high_m);
        CAPTURE(x, z);
        REQUIRE(among.factor(0, x, z) == alone.factor(0, x, z));
        REQUIRE(among.is_flyable(0, x, z) == alone.is_flyable(0, x, z));
        felt += alone.factor(0, x, z) > 1.01;
    }
    CHECK(felt > 1000);
}

TEST_CASE("Over level ground a block keeps the values of a row once, and its arrays those of the whole row") {
    const auto effect = effect_in({{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}}}, 0.2);
    const auto values = [&effect](double to_x_m) {
        const AeroMap map({{effect, 0}}, {}, {-1, to_x_m, 0.1, 2});
        return arrays_of(map, 0).nodes.size();
    };
    CHECK(values(11) == values(1));
    const AeroMap map({{effect, 0}}, {}, {-1, 1, 0.1, 2});
    map.fill();
    const MapView& view = map.view(0);
    CHECK(block_around(view, 3, 3).nodes_size == block_around(view, 30, 3).nodes_size);
    for (std::uint32_t cell = 0; cell < MapBlock::cell_count; ++cell) {
        const MapBlock& block = block_around(view, 3, 3);
        CHECK(block.cells[cell].first_node ==
              block.cells[cell / MapBlock::side_cells * MapBlock::side_cells].first_node);
    }
}

TEST_CASE("Outside its extent a map evaluates directly, and its borders belong to it") {
    const auto effect = effect_in(test::bridge(), 0.15);
    const PlaneOfMotion plane({0, 0, 0}, 0.2);
    const AeroMap map(test::layers(effect, {0.18}), plane, {-1, 1, 1, 2});
    for (const double x : {-7.0, -1.001, 1.06, 3.0}) {
        for (const double z : {0.1, 0.4, 2.06, 8.0}) {
            CHECK(map.factor(0, x, z) == effect->factor(plane.to_world(x, 0.18, z)));
            CHECK(map.is_flyable(0, x, z) == effect->is_flyable(plane.to_world(x, 0.18, z)));
        }
    }
    CHECK(map.factor(0, 0, 0.06) > 1.6);
    const auto coarse = effect_in(test::bridge(), 0.15, 0.07);
    const AeroMap bordered(test::layers(coarse, {0}), {}, {-1, 1, 0.06, 1});
    for (const double x : {-1.0, std::nextafter(1.0, 0.0), 1.0}) {
        for (const double z : {0.06, 0.2, std::nextafter(1.0, 0.0), 1.0}) {
            CHECK(bordered.factor(0, x, z) == Approx(coarse->factor({x, 0, z})).margin(0.01));
        }
    }
}

TEST_CASE(
    "A position that is not finite has the factor 1 in a map and is not flyable, and without effects every one is") {
    const AeroMap map(test::layers(effect_in(test::bridge(), 0.15), {0}), {}, {-1, 1, 0, 1});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity}) {
        CHECK(map.factor(0, bad, 0.5) == 1);
        CHECK(map.factor(0, 0.5, bad) == 1);
        CHECK(!map.is_flyable(0, bad, 0.5));
    }
    AeroSettings settings;
    settings.enabled = false;
    const AeroMap free_air(test::layers(test::effect_in(test::bridge(), 0.15, settings), {0}), {}, {-12, 12, 0, 12});
    CHECK(free_air.factor(0, 3, 5) == 1);
    CHECK(free_air.is_flyable(0, 3, 5));
}

TEST_CASE("A map without extent, place or grid, or of too many cells, is an error") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto effect = effect_in({}, 0.15);
    for (const Bounds& extent : {Bounds{1, 1, 0, 1}, {1, -1, 0, 1}, {0, 1, nan, 1}, {0, 1e6, 0, 1e6}}) {
        CHECK_THROWS_AS(AeroMap(test::layers(effect, {0}), {}, extent), InputError);
    }
    CHECK_THROWS_AS(AeroMap(test::layers(effect, {nan}), {}, {0, 1, 0, 1}), InputError);
    for (const double grid_m : {0.0, -0.05, nan}) {
        CHECK_THROWS_AS(AeroMap(test::layers(effect_in({}, 0.15, grid_m), {0}), {}, {0, 1, 0, 1}), InputError);
    }
}
