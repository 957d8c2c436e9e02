#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../support/hard_places.hpp"
#include "../support/scratch_folder.hpp"
#include "../support/volume_scenes.hpp"
#include "downwash/aeromap/map_cache.hpp"
#include "downwash/aeromap/same_along.hpp"
#include "downwash/aeromap/triquadratic.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/aeromap/volume_patches.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/effects/effect_table.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::effect_in;

namespace {

/// A block in a frame.
struct Block {
    Bounds extent;
    double lateral_low_m, lateral_high_m;
    PlaneOfMotion frame;

    [[nodiscard]] bool contains(const Vector3& hub_m) const {
        const Vector3 at = frame.from_world(hub_m);
        return at[0] >= extent.x_low_m && at[0] <= extent.x_high_m && at[1] >= lateral_low_m &&
               at[1] <= lateral_high_m && at[2] >= extent.z_low_m && at[2] <= extent.z_high_m;
    }
    [[nodiscard]] Vector3 any(test::Random& random) const {
        const double x_m = random.uniform(extent.x_low_m, extent.x_high_m);
        const double lateral_m = random.uniform(lateral_low_m, lateral_high_m);
        return frame.to_world(x_m, lateral_m, random.uniform(extent.z_low_m, extent.z_high_m));
    }
};

VolumeMap map_of(const std::shared_ptr<const DirectEffect>& effect, const Block& block, int threads = 0) {
    VolumeMap map(effect, block.frame, block.extent, block.lateral_low_m, block.lateral_high_m);
    if (threads > 0) {
        map.fill(threads);
    }
    return map;
}

std::vector<Obstacle> random_obstacles(test::Random& random, int count) {
    return test::any_obstacles(random, count, {0.5, 0.4, 0.4});
}

struct Comparison {
    double worst = 0;
    int anywhere = 0, felt = 0, near_edges = 0, at_rims = 0;
};

/// Volume against direct evaluation at flyable hubs: random ones, near edges of shadows, at the least clearance.
Comparison compare(const VolumeMap& map, const Block& block, int tries, unsigned seed) {
    const DirectEffect& effect = map.effect();
    test::Random random(seed);
    Comparison found;
    const auto look = [&](const Vector3& hub_m, int& count) {
        if (block.contains(hub_m) && effect.is_flyable(hub_m)) {
            const double direct = effect.factor(hub_m);
            found.worst = std::max(found.worst, std::abs(map.factor(hub_m) - direct));
            found.felt += std::abs(direct - 1) > 0.05 ? 1 : 0;
            ++count;
        }
    };
    for (int i = 0; i < tries; ++i) {
        look(block.any(random), found.anywhere);
        look(test::near_shadow_edge(random, effect), found.near_edges);
        if (i % 8 == 0) {
            if (const auto hub_m = test::at_rim(effect, block.any(random), block.any(random))) {
                look(*hub_m, found.at_rims);
            }
        }
    }
    return found;
}

}  // namespace

TEST_CASE("A product of parabolas is a quadratic function to the precision of float") {
    const auto f = [](double x, double y, double z) {
        return 1 + x * (2 - x) + 3 * y * z * z - x * x * y * y + x * y * z - 0.5 * x * x * y * y * z * z;
    };
    std::array<double, 27> values{};
    for (std::size_t n = 0; n < values.size(); ++n) {
        const auto at = [](std::size_t i) { return 0.5 * static_cast<double>(i); };
        values[n] = f(at(n % 3), at(n / 3 % 3), at(n / 9));
    }
    const Triquadratic polynomial = triquadratic_through(values);
    test::Random random(70);
    for (int i = 0; i < 1000; ++i) {
        const double x = random.uniform(0, 1);
        const double y = random.uniform(0, 1);
        const double z = random.uniform(0, 1);
        CHECK(std::abs(value_at(polynomial, {x, y, z}) - f(x, y, z)) < 3e-6);
    }
}

TEST_CASE("A volume of random scenes is within 0.01 of the direct effect wherever one may fly, in any frame") {
    test::Random random(71);
    Comparison all;
    for (int scene = 0; scene < 6; ++scene) {
        const double radius_m = random.uniform(0.2, 0.35);
        const auto effect = effect_in(random_obstacles(random, 2), radius_m);
        const double heading_rad = scene == 0 ? 1.5707963267948966 : random.uniform(-3.1, 3.1);
        const Block block{{-0.5, 0.7, -0.6, 0.5}, -0.4, 0.5, PlaneOfMotion({0.1, 0.2, 0.1}, heading_rad)};
        const VolumeMap map = map_of(effect, block);
        const Comparison found = compare(map, block, 10000, 200U + static_cast<unsigned>(scene));
        CAPTURE(scene, found.worst, map.polynomials(), map.memory_bytes());
        CHECK(found.worst <= 0.01);
        all.felt += found.felt;
        all.near_edges += found.near_edges;
        all.at_rims += found.at_rims;
    }
    CHECK(all.felt > 5000);
    CHECK(all.near_edges > 5000);
    CHECK(all.at_rims > 500);
}

TEST_CASE("A volume of a table that rises and falls, and of wall distances, is within 0.01 as well") {
    AeroSettings settings;
    settings.ground = EffectModel::table;
    settings.ground.table = std::make_shared<const EffectTable>(
        std::vector<double>{0.4, 0.8, 1.5, 2.5, 4}, std::vector<double>{1, 1.5, 3},
        std::vector<double>{1.4, 1.35, 1.3, 1.1, 1.12, 1.15, 0.9, 0.93, 1.02, 0.97, 0.98, 1, 1, 1, 1});
    const auto effect = effect_in(
        {{"floor", Box{{6, 6, 1}}, {0, 0, -0.5}, {}}, {"wall", Box{{0.5, 4, 3}}, {0.8, 0, 1.5}, {}}}, 0.3, settings);
    const Block block{{-0.3, 0.3, 0, 0.6}, -0.2, 0.2, {}};
    const Comparison found = compare(map_of(effect, block), block, 10000, 51);
    CAPTURE(found.worst);
    CHECK(found.worst <= 0.01);
    CHECK(found.felt > 2000);
}

TEST_CASE("A volume is the same to the bit for any number of threads and any order of asking") {
    test::Random random(72);
    const auto effect = effect_in(random_obstacles(random, 2), 0.25);
    const Block block{{-1, 1, -0.5, 0.5}, -0.5, 0.5, {}};
    const VolumeMap one = map_of(effect, block, 1);
    CHECK(one.polynomials() > 100);
    CHECK(one.filled_bricks() == one.bricks());
    for (const int threads : {2, 4}) {
        CHECK(map_of(effect, block, threads).to_bytes() == one.to_bytes());
    }
    const VolumeMap asked = map_of(effect, block);
    CHECK(asked.filled_bricks() == 0);
    for (int i = 0; i < 50000; ++i) {
        const Vector3 hub_m = block.any(random);
        REQUIRE(std::bit_cast<std::uint64_t>(one.factor(hub_m)) == std::bit_cast<std::uint64_t>(asked.factor(hub_m)));
    }
    asked.fill();
    CHECK(asked.to_bytes() == one.to_bytes());
}

TEST_CASE(
    "A volume that was asked in part has the same bytes whatever the order and the threads, and its parts add up") {
    test::Random random(75);
    const auto effect = effect_in(random_obstacles(random, 2), 0.25);
    const Block block{{-1, 1, -0.5, 0.5}, -0.5, 0.5, {}};
    std::vector<Vector3> places;
    for (int i = 0; i < 3000; ++i) {
        places.push_back(block.any(random));
    }
    const VolumeMap forth = map_of(effect, block);
    const VolumeMap back = map_of(effect, block);
    const VolumeMap together = map_of(effect, block);
    const VolumeMap first = map_of(effect, block);
    const VolumeMap second = map_of(effect, block);
    for (std::size_t i = 0; i < places.size(); ++i) {
        static_cast<void>(forth.factor(places[i]));
        static_cast<void>(back.factor(places[places.size() - 1 - i]));
        static_cast<void>((i % 3 == 0 ? first : second).factor(places[i]));
    }
    run_parallel(places.size(), 4, [&](std::size_t i) { static_cast<void>(together.factor(places[i])); });
    const std::string bytes = forth.to_bytes();
    CHECK(back.to_bytes() == bytes);
    CHECK(together.to_bytes() == bytes);
    CHECK(first.to_bytes() != bytes);
    VolumeMap both = forth.unfilled();
    REQUIRE(both.add_bytes(first.to_bytes()));
    REQUIRE(both.add_bytes(second.take_new_bytes()));
    CHECK(both.to_bytes() == bytes);
    CHECK(both.take_new_bytes().empty());
    CHECK(both.factor(places[0]) == forth.factor(places[0]));
}

TEST_CASE("What is asked of a volume after it was saved is new again, in bricks that were saved, too") {
    test::Random random(78);
    const auto effect = effect_in(random_obstacles(random, 2), 0.25);
    const Block block{{-1, 1, -0.5, 0.5}, -0.5, 0.5, {}};
    const VolumeMap map = map_of(effect, block);
    VolumeMap saved = map.unfilled();
    for (int part = 0; part < 4; ++part) {
        for (int i = 0; i < 500; ++i) {
            static_cast<void>(map.factor(block.any(random)));
        }
        REQUIRE(saved.add_bytes(map.take_new_bytes()));
        CAPTURE(part);
        CHECK(saved.to_bytes() == map.to_bytes());
    }
    CHECK(map.take_new_bytes().empty());
}

TEST_CASE("At ten thousand random flyable places of three sites a volume is within 0.01, and knows where one may fly") {
    for (const test::VolumeSite& site : {test::girder_bay(), test::pipe_rack(), test::rough_deck(24)}) {
        const VolumeMap map = site.map(site.effect());
        const test::VolumeComparison found = test::compared_at_random(site, map, 10000, 76);
        CAPTURE(site.name, found.worst, found.felt);
        CHECK(found.worst <= 0.01);
        CHECK(found.felt > 300);
        CHECK(found.misjudged == 0);
    }
}

TEST_CASE("Along a girder one sample stands for all, and at its end none does") {
    const test::VolumeSite bay = test::girder_bay();
    const auto effect = bay.effect();
    const auto around = [](const Vector3& low_m, double edge_m) {
        return BoundingBox{low_m, {low_m[0] + edge_m, low_m[1] + edge_m, low_m[2] + edge_m}};
    };
    const SameAlong beside_web = same_along(*effect, {}, around({-3, 0.2, 3}, 0.1));
    CHECK(beside_web.x);
    CHECK_FALSE(beside_web.lateral);
    const SameAlong middle = same_along(*effect, {}, around({-3, 1.4, 3}, 0.1));
    CHECK((middle.x && middle.lateral));
    const SameAlong at_frame = same_along(*effect, {}, around({-0.2, 1.4, 3}, 0.1));
    CHECK_FALSE((at_frame.x || at_frame.lateral));
    const SameAlong at_end = same_along(*effect, {}, around({6.9, 0.2, 3}, 0.1));
    CHECK_FALSE((at_end.x || at_end.lateral));
    const SameAlong turned = same_along(*effect, PlaneOfMotion({0, 0, 0}, 0.2), around({-3, 0.2, 3}, 0.1));
    CHECK_FALSE((turned.x || turned.lateral));
    // What it says is true: K does not change along an axis that it names, wherever that is.
    test::Random random(77);
    int named = 0;
    for (int i = 0; i < 3000; ++i) {
        const BoundingBox hubs = around(bay.any(random), 0.1);
        const SameAlong same = same_along(*effect, {}, hubs);
        const auto any = [&](std::size_t axis) { return random.uniform(hubs.low_m[axis], hubs.high_m[axis]); };
        const Vector3 at{any(0), any(1), any(2)};
        if (same.x) {
            CHECK(effect->factor({any(0), at[1], at[2]}) == Approx(effect->factor(at)).margin(1e-9));
            ++named;
        }
        if (same.lateral) {
            CHECK(effect->factor({at[0], any(1), at[2]}) == Approx(effect->factor(at)).margin(1e-9));
            ++named;
        }
    }
    CHECK(named > 2000);
}

TEST_CASE("In a girder bay a volume is within 0.01 by side, and knows where one may fly") {
    std::vector<Obstacle> bay{{"deck", Box{{12, 14, 0.216}}, {0, 0, 4}, {}},
                              {"cross frame", Box{{0.1, 14, 0.1}}, {0.5, 0, 2.7}, {}}};
    for (const double y_m : {-2.97, 0.0, 2.97}) {
        bay.push_back({"web", Box{{12, 0.02, 1.37}}, {0, y_m, 3.2}, {}});
        bay.push_back({"flange", Box{{12, 0.36, 0.03}}, {0, y_m, 2.5}, {}});
    }
    const auto effect = effect_in(bay, 0.229);
    const VolumeMap map(effect, {}, {-6, 6, 0, 4}, -7, 7);
    const std::size_t empty_bytes = map.memory_bytes();
    test::Random random(73);
    double worst = 0;
    int flyable = 0;
    int known = 0;
    VolumePatches<1> patches;
    VolumeLookUp<double> look_up(map.view(), patches);
    double apart = 0;
    for (int i = 0; i < 40000; ++i) {
        const Vector3 hub_m{random.uniform(-0.6, 1.2), random.uniform(-0.8, 0.8), random.uniform(1.8, 3.9)};
        const bool is_flyable = effect->is_flyable(hub_m);
        const double margin_m = map.margin_m(hub_m);
        known += margin_m != 0 ? 1 : 0;
        REQUIRE((margin_m == 0 || (margin_m > 0) == is_flyable));
        REQUIRE(map.is_flyable(hub_m) == is_flyable);
        const SidedFactor<double> looked_up = map.sided_factor(hub_m);
        const SidedFactor<double> by_patch = look_up.at(hub_m[0], hub_m[1], hub_m[2]);
        apart = std::max({apart, std::abs(by_patch.all - looked_up.all), std::abs(by_patch.above - looked_up.above),
                          std::abs(look_up.margin_m(hub_m[0], hub_m[1], hub_m[2]) - margin_m)});
        if (is_flyable) {
            const SidedFactor<double> direct = effect->sided_factor(hub_m);
            worst = std::max({worst, std::abs(looked_up.all - direct.all), std::abs(looked_up.above - direct.above)});
            ++flyable;
        }
    }
    CAPTURE(worst, flyable, known, apart, map.memory_bytes());
    CHECK(worst <= 0.01);
    CHECK(flyable > 20000);
    CHECK(known > 30000);
    CHECK(apart < 1e-5);
    CHECK(map.memory_bytes() > empty_bytes);
    CHECK(map.memory_bytes() < 8'000'000);

    SECTION("far from all surfaces bricks take no memory") {
        CHECK(map.factor({-4, -5, 0.3}) == 1);
        const std::size_t bytes = map.memory_bytes();  // with the page of their places
        const std::size_t bricks = map.filled_bricks();
        for (const double x_m : {-5.0, -3.0, -2.0, 3.0, 5.0}) {
            CHECK(map.factor({x_m, -5, 0.3}) == 1);
        }
        CHECK(map.filled_bricks() == bricks + 5);
        CHECK(map.memory_bytes() == bytes);
    }
    SECTION("the cache gives back what was filled, to the last bit") {
        const test::ScratchFolder folder;
        CHECK(MapCache(folder.path()).keep(map));
        VolumeMap again = map.unfilled();
        CHECK(MapCache(folder.path()).read(again));
        CHECK(again.to_bytes() == map.to_bytes());
        VolumeMap other(effect, {}, {-6, 6, 0, 4.5}, -7, 7);
        CHECK_FALSE(MapCache(folder.path()).read(other));
        std::string bytes = map.to_bytes();
        bytes.pop_back();
        CHECK_FALSE(map.unfilled().add_bytes(bytes));
    }
}

TEST_CASE("Without effects a volume keeps no values") {
    AeroSettings disabled;
    disabled.enabled = false;
    for (const auto& none : {effect_in({}, 0.2), effect_in(test::bridge(), 0.2, disabled)}) {
        const VolumeMap map(none, {}, {-2, 2, 8, 10}, -1, 1);
        map.fill();
        CHECK(map.polynomials() == 0);
        CHECK(map.factor({0.3, 0.2, 9.1}) == 1);
    }
}

TEST_CASE("Outside its block a volume evaluates directly, and its borders belong to it") {
    const auto effect = effect_in({{"floor", Box{{8, 8, 1}}, {0, 0, -0.5}, {}}}, 0.2);
    const VolumeMap map(effect, {}, {-1, 1, 0.1, 1}, -0.5, 0.5);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vector3& hub_m : {Vector3{-1, -0.5, 0.1}, {1, 0.5, 1}, {1, -0.5, 0.1}, {0, 0.5, 1}}) {
        CHECK(map.factor(hub_m) == Approx(effect->factor(hub_m)).margin(0.01));
    }
    for (const Vector3& hub_m : {Vector3{-1.01, 0, 0.2}, {0, 0.6, 0.2}, {0, 0, 0.09}, {0, 0, 1.01}}) {
        CHECK(map.factor(hub_m) == effect->factor(hub_m));
    }
    CHECK(map.factor({nan, 0, 0.2}) == 1);
    CHECK(map.factor({0, std::numeric_limits<double>::infinity(), 0.2}) == 1);
}

TEST_CASE("A volume without extent or of too many cells is an error") {
    const auto effect = effect_in({}, 0.2);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const double largest = std::numeric_limits<double>::max();
    for (const Block& block : {Block{{1, 1, 0, 1}, 0, 1, {}},
                               {{0, 1, 0, nan}, 0, 1, {}},
                               {{0, 1, 0, 1}, 1, 0, {}},
                               {{0, 1, 0, 1}, 0, infinity, {}},
                               {{-1e6, 1e6, -1e6, 1e6}, -1e6, 1e6, {}},
                               {{-largest, largest, -largest, largest}, -largest, largest, {}}}) {
        CHECK_THROWS_AS(map_of(effect, block), InputError);
    }
}

TEST_CASE("A volume of walls is within 0.01 of the vector towards the nearest wall") {
    const auto effect = std::make_shared<const DirectEffect>(
        DirectEffect::walls_around(test::scene_of({{"wall", Box{{0.4, 4, 3}}, {0, 0, 1.5}, {}}}), {}, 0.2, 0.3));
    const VolumeMap map(effect, {}, {-2, 2, 0.5, 2}, -1, 1);
    test::Random random(74);
    double longest = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3 center_m{random.uniform(0.3, 0.9), random.uniform(-0.4, 0.4), random.uniform(1, 1.5)};
        const Vector3 direct = effect->towards_wall(center_m);
        const SidedFactor<double> looked_up = map.sided_factor(center_m);
        REQUIRE(std::abs(looked_up.all - direct[0]) <= 0.01);
        REQUIRE(std::abs(looked_up.above - direct[1]) <= 0.01);
        CHECK(direct[0] <= 0);  // the wall is behind
        longest = std::max(longest, -direct[0]);
    }
    CHECK(longest > 0.99);
}

TEST_CASE("A large volume takes memory where somebody asks, and one too large is refused") {
    const auto effect = effect_in({{"ground", Box{{400, 400, 1}}, {0, 0, -0.5}, {}}}, 0.1);
    const Bounds wide{-50, 50, 0, 50};
    REQUIRE(VolumeMap::fits(wide, -35, 35, 0.1));
    const VolumeMap map(effect, {}, wide, -35, 35);
    CHECK(map.bricks() > 50'000'000);
    const Vector3 corner{49.9, 34.9, 0.15};
    CHECK(map.factor(corner) == Approx(effect->factor(corner)).margin(0.01));
    CHECK(map.filled_bricks() == 1);
    CHECK(map.memory_bytes() < 100'000);
    VolumeMap same = map.unfilled();
    REQUIRE(same.add_bytes(map.to_bytes()));
    CHECK(same.to_bytes() == map.to_bytes());

    CHECK_FALSE(VolumeMap::fits(wide, -70, 70, 0.1));
    CHECK_THROWS_AS(VolumeMap(effect, {}, wide, -70, 70), InputError);
}
