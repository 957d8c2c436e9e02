#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>
#include <span>

#include "downwash/scene/line_of_sight.hpp"
#include "downwash/scene/parted_space.hpp"

// Ways of a ball among obstacles: walls of any thickness part, doors do not, and a straight free way is always found.

using namespace downwash;

namespace {

constexpr SpaceBounds bounds{{-3, -3, 0}, {3, 3, 3}};

Obstacle plate(const Vector3& size_m, const Vector3& center_m) {
    return {"", Box{size_m}, center_m, {}};
}

/// A wall of a millimetre across the bounds at x = 0, with a door of some width in the middle.
std::shared_ptr<const Scene> wall_with_door(double width_m) {
    std::vector<Obstacle> all = {plate({1, 1, 1}, {-2, -2, 0.5})};
    if (width_m == 0) {
        all.push_back(plate({0.001, 20, 20}, {0.0123, 0, 0}));
    } else {
        all.push_back(plate({0.001, 10, 20}, {0.0123, 5 + 0.5 * width_m, 0}));
        all.push_back(plate({0.001, 10, 20}, {0.0123, -5 - 0.5 * width_m, 0}));
    }
    return std::make_shared<const Scene>(all);
}

std::optional<BallWay> way(const std::shared_ptr<const Scene>& scene, double radius_m, const Vector3& from_m,
                           const Vector3& to_m, std::size_t max_cubes = 200'000) {
    return way_of_ball(scene, bounds, radius_m, from_m, std::span(&to_m, 1), max_cubes);
}

}  // namespace

TEST_CASE("A thin wall parts a box, and a door wider than the ball does not") {
    const Vector3 here{-2, 1, 1.5}, there{2, -1, 1.5};
    const std::optional<BallWay> closed = way(wall_with_door(0), 0.3, here, there);
    REQUIRE(closed);
    CHECK(closed->is_parted);
    CHECK(closed->obstacles.back() == 1);
    for (const double width_m : {0.61, 1.0}) {
        const std::optional<BallWay> open = way(wall_with_door(width_m), 0.3, here, there);
        REQUIRE(open);
        CHECK_FALSE(open->is_parted);
    }
    // Narrower than what the cubes can tell: 0.39 radii to each side.
    CHECK(way(wall_with_door(0.22), 0.3, here, there)->is_parted);
    CHECK_FALSE(way(wall_with_door(0), 0.3, here, {-1, 2, 2})->is_parted);
    // Of several places one is enough.
    const std::array both{there, Vector3{-1, 2, 2}};
    CHECK_FALSE(way_of_ball(wall_with_door(0), bounds, 0.3, here, both)->is_parted);
    CHECK_FALSE(way(wall_with_door(0), 0.3, here, there, 100).has_value());
}

TEST_CASE("A ball that can fly straight to a place is never parted from it") {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> side(-2.7, 2.7), height(0.3, 2.7), size(0.05, 1), turn(-3, 3);
    int straight = 0, parted = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<Obstacle> all;
        for (int k = 0; k < 8; ++k) {
            all.push_back({"",
                           Box{{size(random), size(random), size(random)}},
                           {side(random), side(random), height(random)},
                           {turn(random), turn(random), turn(random)}});
        }
        const auto scene = std::make_shared<const Scene>(all);
        const Vector3 from_m{side(random), side(random), height(random)};
        const Vector3 to_m{side(random), side(random), height(random)};
        constexpr double radius_m = 0.25;
        if (!is_line_clear(*scene, from_m, to_m, radius_m)) {
            continue;
        }
        const std::optional<BallWay> found = way(scene, radius_m, from_m, to_m);
        ++straight;
        parted += found && found->is_parted ? 1 : 0;
    }
    CHECK(straight > 40);
    CHECK(parted == 0);
}
