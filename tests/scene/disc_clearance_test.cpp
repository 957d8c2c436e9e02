#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "downwash/scene/collision_checker.hpp"
#include "reference.hpp"

using namespace downwash;
using reference::about;

namespace {

Scene scene_of(const Shape& shape, const Vector3& center_m = {}, const Vector3& rpy_rad = {}) {
    return Scene({{"", shape, center_m, rpy_rad}});
}

}  // namespace

TEST_CASE("A disc that touches has no clearance and is never clear, without obstacles it is infinitely clear") {
    const Scene scene = scene_of(Box{{1, 1, 1}});
    for (const Vector3& center : {Vector3{0, 0, 0}, {0.6, 0, 0.3}, {0.55, 0.55, -0.4}}) {
        CHECK(disc_clearance_m(scene, center, 0.2) == about(0));
        CHECK_FALSE(disc_is_clear(scene, center, 0.2, 0));
    }
    CHECK(disc_is_clear(scene, {0.75, 0, 0}, 0.2, 0));
    CHECK(disc_clearance_m(scene, {-0.6, 0, 0.75}, 5) == about(0.25));  // far larger than the box
    CHECK(disc_clearance_m(scene_of(Cylinder{0.01, 3, {0, 0, 1}}), {0.05, 0, 0}, 0.2) == about(0));
    CHECK(disc_clearance_m(Scene({}), {0, 0, 0}, 1) == std::numeric_limits<double>::infinity());
    CHECK(disc_is_clear(Scene({}), {0, 0, 0}, 1, 1e9));
}

TEST_CASE("Disc clearance agrees with alternating projections in random scenes") {
    reference::Dice dice(11);
    for (int round = 0; round < 500; ++round) {
        const std::vector<Obstacle> obstacles = dice.obstacles(2);
        const Scene scene(obstacles);
        const Vector3 center = dice.vector(-2.5, 2.5);
        const double radius = dice.between(0.05, 0.6);
        const reference::Enclosure truth = reference::clearance({reference::disc(center, radius)}, obstacles);
        const double clearance = disc_clearance_m(scene, center, radius);
        CAPTURE(round, truth.low, truth.high, clearance);
        REQUIRE(clearance >= 0);
        REQUIRE(truth.holds(clearance));
    }
}

TEST_CASE("A disc is clear where its clearance says so") {
    reference::Dice dice(12);
    int clear = 0;
    for (int round = 0; round < 2000; ++round) {
        const Scene scene(dice.obstacles(3));
        const Vector3 center = dice.vector(-2.5, 2.5);
        const double radius = dice.between(0.05, 0.6);
        const double clearance = disc_clearance_m(scene, center, radius);
        const double distance = dice.coin() ? dice.between(0, 1) : clearance + dice.between(-1e-6, 1e-6);
        if (distance >= 0 && clearance > 0 && std::abs(clearance - distance) > 1e-9) {
            CAPTURE(round, clearance, distance);
            REQUIRE(disc_is_clear(scene, center, radius, distance) == (clearance >= distance));
            clear += clearance >= distance;
        }
    }
    CHECK(clear > 300);
}

TEST_CASE("A column over a disc is clear of what stands beside it, below it and higher up") {
    const Scene slab = scene_of(Box{{2, 2, 0.2}}, {0, 0, 1.1});  // from 1 m up
    CHECK(column_is_clear(slab, {0, 0, 0}, 0.2, 0.999));
    CHECK_FALSE(column_is_clear(slab, {0, 0, 0}, 0.2, 1.001));
    CHECK(column_is_clear(slab, {1.201, 0, 0}, 0.2, 5));        // beside its edge
    CHECK_FALSE(column_is_clear(slab, {1.199, 0, 0}, 0.2, 5));  // a millimetre under it
    CHECK(column_is_clear(slab, {0, 0, 1.3}, 0.2, 5));          // over it
    CHECK(column_is_clear(Scene({}), {0, 0, 0}, 1, 1e9));
    // Under a slope of 0.3 rad the edge of the disc on the low side is the nearest.
    const double slope = 0.3;
    const Scene sloped = scene_of(Box{{20, 20, 2}}, {0, 0, 3}, {0, slope, 0});
    const double gap = 3 - 1 / std::cos(slope) - 0.4 * std::tan(slope);
    CHECK(column_is_clear(sloped, {0, 0, 0}, 0.4, gap - 1e-4));
    CHECK_FALSE(column_is_clear(sloped, {0, 0, 0}, 0.4, gap + 1e-4));
    // The lowest point of a pipe of radius 0.3 m at 1 m, seen from the rim of a disc 0.4 m aside.
    const Scene pipe = scene_of(Cylinder{0.3, 20, {0, 1, 0}}, {0, 0, 1});
    const double rim_gap = 1 - std::sqrt(0.3 * 0.3 - 0.2 * 0.2);
    CHECK(column_is_clear(pipe, {0.4, 0, 0}, 0.2, rim_gap - 1e-4));
    CHECK_FALSE(column_is_clear(pipe, {0.4, 0, 0}, 0.2, rim_gap + 1e-4));
}

TEST_CASE("The distance to walls is measured within the horizontal plane") {
    const auto at = [](const Shape& shape, const Vector3& rpy_rad, const Vector3& point) {
        return horizontal_clearance_m(scene_of(shape, {}, rpy_rad), point);
    };
    const auto is = [](double expected) { return Approx(expected).epsilon(0).margin(1e-8); };
    SECTION("to the face, edge and corner of an upright box, at any height that cuts it") {
        for (const double z : {-0.9, 0.0, 0.999, 1.0}) {
            CHECK(at(Box{{2, 4, 2}}, {}, {3, 0.5, z}) == is(2));
            CHECK(at(Box{{2, 4, 2}}, {}, {4, 6, z}) == is(5));
            CHECK(at(Box{{2, 4, 2}}, {}, {0.5, 1, z}) == 0);
        }
        CHECK(std::isinf(at(Box{{2, 4, 2}}, {}, {3, 0, 1.001})));
        CHECK(std::isinf(at(Box{{2, 4, 2}}, {}, {0, 0, -1.001})));
        CHECK(std::isinf(horizontal_clearance_m(Scene({}), {0, 0, 0})));
    }
    SECTION("to a wall that leans") {
        for (const double lean : {0.1, 0.5, 1.0, 1.4}) {
            // The face x = 1 of the box turned about y meets height z at x = 1 / cos + z tan.
            CHECK(at(Box{{2, 40, 400}}, {0, lean, 0}, {9, 0.3, 0.2}) ==
                  is(9 - 1 / std::cos(lean) - 0.2 * std::tan(lean)));
        }
    }
    SECTION("to a ball and to a pipe along y, which circles and strips cut") {
        for (const double z : {0.0, 0.3, 0.6, -0.8}) {
            CHECK(at(Sphere{1}, {}, {3, 4, z}) == is(5 - std::sqrt(1 - z * z)));
            CHECK(at(Cylinder{1, 10, {0, 1, 0}}, {}, {3, 4, z}) == is(3 - std::sqrt(1 - z * z)));
            CHECK(at(Cylinder{1, 10, {0, 0, 1}}, {}, {3, 4, z}) == is(4));
        }
    }
    SECTION("to the nearest of several") {
        const Scene scene(
            {{"", Sphere{1}, {5, 0, 0}, {}}, {"", Box{{1, 1, 1}}, {0, 2, 0}, {}}, {"", Sphere{1}, {}, {}}});
        CHECK(horizontal_clearance_m(scene, {3, 0, 0}) == is(1));
        CHECK(horizontal_clearance_m(scene, {1, 3, 0}) == is(std::sqrt(0.5)));
    }
}

TEST_CASE("No point of a circle within the distance to walls touches, and beyond it one does") {
    reference::Dice dice(13);
    int cut = 0;
    for (int round = 0; round < 2000; ++round) {
        const Scene scene(dice.obstacles(3));
        const Vector3 p = dice.vector(-2, 2);
        const double distance = horizontal_clearance_m(scene, p);
        const double bounded = std::min(distance, 10.0);
        CAPTURE(round, distance);
        REQUIRE((bounded == 0 || disc_clearance_m(scene, p, 0.9999 * bounded) > 0));
        if (distance < 10) {
            REQUIRE(disc_clearance_m(scene, p, distance + 1e-4) < 1e-6);
            ++cut;
        }
    }
    CHECK(cut > 500);
}
