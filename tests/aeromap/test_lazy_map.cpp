#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <numeric>
#include <thread>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "scenes.hpp"

using namespace downwash;

namespace {

constexpr Bounds extent{-3.1, 0.3, 0.4, 3.3};

/// A part of the bridge in two layers that differ: a pier, girders, cells that are mixed, a last block that is cut off.
AeroMap empty_map() {
    AeroSettings settings;
    settings.grid_m = 0.06;
    static const auto effect = test::effect_in(test::bridge(), 0.17, settings);
    return {test::layers(effect, {-0.2, 0.3}), PlaneOfMotion({0, 0.1, 0}, 0.05), extent};
}

/// A place in every block of every layer.
std::vector<LayerPlace> places_in_blocks(const AeroMap& map) {
    std::vector<LayerPlace> places;
    for (std::size_t layer = 0; layer < map.layers().size(); ++layer) {
        const MapView& view = map.view(layer);
        for (std::uint32_t k = 0; k < view.rows; k += MapBlock::side_cells) {
            for (std::uint32_t i = 0; i < view.columns; i += MapBlock::side_cells) {
                places.push_back(
                    {layer, view.x_low_m + (i + 0.5) / view.cells_per_m, view.z_low_m + (k + 0.5) / view.cells_per_m});
            }
        }
    }
    return places;
}

void shuffle(test::Random& random, std::vector<LayerPlace>& places) {
    for (std::size_t i = places.size(); i > 1; --i) {
        std::swap(places[i - 1], places[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    }
}

}  // namespace

TEST_CASE("a map has the same bytes in 100 random orders of asking, on any number of threads") {
    const AeroMap whole = empty_map();
    whole.fill();
    const std::string bytes = whole.to_bytes();
    test::Random random(3);
    for (int order = 0; order < 100; ++order) {
        const AeroMap map = empty_map();
        std::vector<LayerPlace> places = places_in_blocks(map);
        REQUIRE(places.size() > 50);
        {
            std::vector<std::jthread> threads;
            for (int thread = 1 + order % 4; thread > 0; --thread) {
                shuffle(random, places);
                threads.emplace_back([&map, places, thread] {
                    double sum = 0;
                    for (const auto& [layer, x_m, z_m] : places) {
                        sum += thread % 2 == 0 ? map.factor(layer, x_m, z_m)
                                               : static_cast<double>(map.is_flyable(layer, x_m, z_m));
                    }
                    volatile double kept = sum;
                    static_cast<void>(kept);
                });
            }
        }
        CAPTURE(order);
        REQUIRE(map.filled_share() == 1);
        REQUIRE(map.to_bytes() == bytes);
    }
}

TEST_CASE("a look-up fills its block and no other") {
    const AeroMap map = empty_map();
    CHECK(map.filled_share() == 0);
    CHECK(map.filling_s() == 0);
    const std::vector<LayerPlace> places = places_in_blocks(map);
    const double one = 1 / static_cast<double>(places.size());
    const auto& [layer, x_m, z_m] = places[17];
    static_cast<void>(map.factor(layer, x_m, z_m));
    CHECK(map.filled_share() == one);
    CHECK(map.filling_s() > 0);
    static_cast<void>(map.sided_factor(layer, x_m, z_m));
    static_cast<void>(map.is_flyable(layer, x_m, z_m));
    static_cast<void>(map.factor(layer, -10, 2));  // outside
    static_cast<void>(map.is_flyable(layer, -10, 2));
    CHECK(map.filled_share() == one);
    const AeroMap copy = map;
    static_cast<void>(copy.factor(places[30].layer, places[30].x_m, places[30].z_m));
    CHECK(map.filled_share() == 2 * one);
    CHECK(map.to_bytes() == copy.to_bytes());
}

TEST_CASE("the blocks around some places are those of the whole map") {
    const AeroMap whole = empty_map();
    whole.fill(2);
    const AeroMap map = empty_map();
    const std::vector<LayerPlace> all = places_in_blocks(map);
    const std::vector<LayerPlace> some{all[3], all[3], all[20], all.back(), {0, 100, 100}};
    int reports = 0;
    map.fill_around(some, 2, [&](double share) { reports += share > 0 && share <= 1 ? 1 : 0; });
    CHECK(reports > 0);
    CHECK(map.filled_share() == 3 / static_cast<double>(all.size()));
    for (const auto& [layer, x_m, z_m] : some) {
        CHECK(map.factor(layer, x_m, z_m) == whole.factor(layer, x_m, z_m));
    }
    const double share = map.filled_share();
    reports = 0;
    map.fill_around(some, 2, [&](double) { ++reports; });
    CHECK(reports == 0);
    CHECK(map.filled_share() == share);
}

TEST_CASE("filling can be stopped, and goes on with what is left") {
    const AeroMap whole = empty_map();
    whole.fill();
    const AeroMap map = empty_map();
    CHECK_THROWS_AS(map.fill(1, {}, [] { return true; }), WorkStopped);
    CHECK(map.filled_share() == 0);
    std::atomic<int> asked{0};
    empty_map().fill(1, {}, [&asked] { return ++asked < 0; });
    const int half = asked / 2;
    asked = 0;
    CHECK_THROWS_AS(map.fill(2, {}, [&asked, half] { return ++asked > half; }), WorkStopped);
    CHECK(map.filled_share() > 0);
    CHECK(map.filled_share() < 1);
    std::vector<double> shares;
    map.fill(2, [&shares](double share) { shares.push_back(share); });
    CHECK(std::is_sorted(shares.begin(), shares.end()));
    CHECK(map.to_bytes() == whole.to_bytes());
}

TEST_CASE("a map that follows a change keeps blocks away from it, and fills the others as in the new scene") {
    test::Random random(23);
    std::vector<Obstacle> before = test::bridge();
    std::vector<Obstacle> after = before;
    after.push_back({"crate", Box{{0.3, 0.3, 0.3}}, {-2.2, 0, 0.6}, {}});
    const auto layers_in = [](const std::vector<Obstacle>& obstacles) {
        return test::layers(test::effect_in(obstacles, 0.17), {-0.2, 0.3});
    };
    const AeroMap old(layers_in(before), {}, {-3, 3, 0.4, 3});
    std::vector<LayerPlace> places = places_in_blocks(old);
    shuffle(random, places);
    places.resize(places.size() / 2);
    old.fill_around(places, 2);
    const AeroMap anew(layers_in(after), {}, {-3, 3, 0.4, 3});
    anew.fill(2);
    const AeroMap following = old.rebuilt(layers_in(after), {Scene({after.back()}).bounds(0)});
    CHECK(following.filling_s() == 0);
    CHECK(following.filled_share() > 0.5 * old.filled_share());
    CHECK(following.filled_share() < 0.9 * old.filled_share());
    following.fill(2);
    CHECK(following.to_bytes() == anew.to_bytes());
    CHECK(old.factor(0, -2.2, 0.9) != following.factor(0, -2.2, 0.9));
}
