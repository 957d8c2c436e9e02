#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "downwash/scene/scene.hpp"
#include "downwash/scene/shadow_outline.hpp"
#include "reference.hpp"

using namespace downwash;

namespace {

constexpr double quarter_turn = 1.57079632679489661923;

/// Near the origin, a third of them at whole and half right angles, where formulas degenerate.
Obstacle any_obstacle(reference::Dice& dice) {
    Obstacle obstacle = dice.between(0, 3) < 1 ? dice.gridded_obstacle() : dice.obstacle();
    obstacle.center_world_m = dice.vector(-0.2, 0.2);
    return obstacle;
}

}  // namespace

TEST_CASE("A vertical line is inside an obstacle exactly over its vertical extent") {
    reference::Dice dice(14);
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        const Obstacle obstacle = any_obstacle(dice);
        const reference::Solid solid = reference::solid_of(obstacle);
        const Scene scene({obstacle});
        const double x = dice.between(-0.7, 0.7);
        const double y = dice.between(-0.7, 0.7);
        const Interval extent = scene.vertical_extent(0, x, y);
        for (int j = 0; j < 40; ++j) {
            const double z = dice.between(-1.2, 1.2);
            const double from_end = std::min(std::abs(z - extent.low), std::abs(z - extent.high));
            const bool is_within = extent.low < z && z < extent.high;
            inside += is_within;
            if (extent.empty() || from_end > 1e-6) {
                REQUIRE(is_within == (reference::distance_to_point(solid, {x, y, z}) < 1e-12));
            }
        }
        if (!extent.empty()) {
            CHECK(reference::distance_to_point(solid, {x, y, extent.low}) < 1e-9);
            CHECK(reference::distance_to_point(solid, {x, y, extent.high}) < 1e-9);
        }
    }
    CHECK(inside > 3000);
}

TEST_CASE("A horizontal line is in the shadow exactly where vertical lines meet the obstacle") {
    reference::Dice dice(15);
    int shaded = 0;
    for (int i = 0; i < 2000; ++i) {
        const Scene scene({any_obstacle(dice)});
        const double px = dice.between(-0.7, 0.7);
        const double py = dice.between(-0.7, 0.7);
        const double angle = i % 3 == 0 ? quarter_turn * std::round(dice.between(0, 3)) : dice.between(-3, 3);
        const double dx = std::cos(angle);
        const double dy = std::sin(angle);
        const Interval shadow = scene.shadow_on_line(0, px, py, dx, dy);
        for (int j = 0; j < 40; ++j) {
            const double s = dice.between(-1.5, 1.5);
            const bool is_met = !scene.vertical_extent(0, px + s * dx, py + s * dy).empty();
            const double from_end = std::min(std::abs(s - shadow.low), std::abs(s - shadow.high));
            shaded += is_met;
            if (shadow.empty() || from_end > 1e-6) {
                REQUIRE(is_met == (shadow.low < s && s < shadow.high));
            }
        }
    }
    CHECK(shaded > 5000);
}

TEST_CASE("Boxes without roll and pitch and upright cylinders are level") {
    const Scene scene({{"", Box{{1, 2, 3}}, {}, {0, 0, 0.7}},
                       {"", Box{{1, 2, 3}}, {}, {quarter_turn, 2 * quarter_turn, 0.7}},
                       {"", Box{{1, 2, 3}}, {}, {0, 1e-3, 0}},
                       {"", Cylinder{1, 1, {0, 0, -2}}, {}, {0, 0, 1}},
                       {"", Cylinder{1, 1, {0, 1, 0}}, {}, {quarter_turn, 0, 0}},
                       {"", Cylinder{1, 1, {0, 1, 0}}, {}, {}},
                       {"", Sphere{1}, {}, {}}});
    const std::array expected{true, true, false, true, true, false, false};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(scene.is_level(i) == expected[i]);
    }
}

TEST_CASE("Outlines show each edge once") {
    const Scene scene({{"", Box{{1, 2, 3}}, {}, {0, 0, 0.7}},
                       {"", Box{{1, 2, 3}}, {}, {0.3, 0.4, 0.7}},
                       {"", Cylinder{1, 4, {0, 0, 1}}, {}, {}},
                       {"", Cylinder{1, 4, {0, 1, 0}}, {}, {}},
                       {"", Cylinder{1, 4, {0, 1, 1}}, {}, {}},
                       {"", Sphere{1}, {}, {}}});
    const std::vector<std::array<std::size_t, 2>> expected{{4, 0}, {12, 0}, {0, 1}, {4, 0}, {2, 2}, {0, 1}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const ShadowOutline outline = shadow_outline(scene, i);
        CHECK(outline.segments.size() == expected[i][0]);
        CHECK(outline.ellipses.size() == expected[i][1]);
    }
    const ShadowOutline tilted = shadow_outline(scene, 1);
    // Of the twelve edges of a box, three are hidden from above and three others from below.
    const auto seen = [&](bool OutlineSegment::*flag) {
        return std::count_if(tilted.segments.begin(), tilted.segments.end(),
                             [&](const OutlineSegment& segment) { return segment.*flag; });
    };
    CHECK(seen(&OutlineSegment::seen_from_above) == 9);
    CHECK(seen(&OutlineSegment::seen_from_below) == 9);
}
