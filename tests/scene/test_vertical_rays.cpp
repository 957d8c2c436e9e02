#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/random.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/shadow_outline.hpp"

using namespace downwash;

namespace {

constexpr double quarter_turn = 1.57079632679489661923;

/// The point in the obstacle's own frame, with the C library's angles.
Vector3 local(const Obstacle& obstacle, const Vector3& p) {
    Vector3 d{p[0] - obstacle.center_world_m[0], p[1] - obstacle.center_world_m[1], p[2] - obstacle.center_world_m[2]};
    const auto turn_back = [&](std::size_t a, std::size_t b, double angle) {
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        const double da = c * d[a] + s * d[b];
        d[b] = c * d[b] - s * d[a];
        d[a] = da;
    };
    turn_back(0, 1, obstacle.rpy_rad[2]);
    turn_back(2, 0, obstacle.rpy_rad[1]);
    turn_back(1, 2, obstacle.rpy_rad[0]);
    return d;
}

/// Below 0 inside, above 0 outside: how far a size would have to grow to meet the point.
double outside_by(const Obstacle& obstacle, const Vector3& p_world) {
    const Vector3 p = local(obstacle, p_world);
    if (const auto* box = std::get_if<Box>(&obstacle.shape)) {
        double most = -1e9;
        for (std::size_t k = 0; k < 3; ++k) {
            most = std::max(most, std::abs(p[k]) - 0.5 * box->size_m[k]);
        }
        return most;
    }
    const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    if (const auto* sphere = std::get_if<Sphere>(&obstacle.shape)) {
        return std::sqrt(square) - sphere->radius_m;
    }
    const auto& cylinder = std::get<Cylinder>(obstacle.shape);
    const Vector3& axis = cylinder.axis;
    const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double along = (p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]) / length;
    const double across = std::sqrt(std::max(0.0, square - along * along));
    return std::max(std::abs(along) - 0.5 * cylinder.length_m, across - cylinder.radius_m);
}

/// Any shape, in any position: a third of them square to the world, where formulas degenerate.
Obstacle any_obstacle(test::Random& random) {
    const auto size = [&] { return random.uniform(0.1, 2); };
    const auto coordinate = [&] { return random.uniform(-1, 1); };
    Obstacle obstacle{"", Sphere{size()}, {coordinate(), coordinate(), coordinate()}, {}};
    const int kind = random.integer(0, 2);
    if (kind == 1) {
        obstacle.shape = Box{{size(), size(), size()}};
    } else if (kind == 2) {
        obstacle.shape = Cylinder{size(), size(), {coordinate(), coordinate(), coordinate()}};
        if (random.integer(0, 1) == 0) {
            std::get<Cylinder>(obstacle.shape).axis = {0, 0, 0};
            std::get<Cylinder>(obstacle.shape).axis[static_cast<std::size_t>(random.integer(0, 2))] = -2;
        }
    }
    const int pose = random.integer(0, 2);
    for (std::size_t k = 0; k < 3; ++k) {
        obstacle.rpy_rad[k] = pose == 0 ? quarter_turn * random.integer(-2, 2) : random.uniform(-3, 3);
    }
    if (pose == 1) {
        obstacle.rpy_rad[0] = obstacle.rpy_rad[1] = 0;
    }
    return obstacle;
}

}  // namespace

TEST_CASE("A vertical line is inside an obstacle exactly over its vertical extent") {
    test::Random random(1);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Obstacle obstacle = any_obstacle(random);
        const Scene scene({obstacle});
        const double x = random.uniform(-2, 2);
        const double y = random.uniform(-2, 2);
        const Interval extent = scene.vertical_extent(0, x, y);
        for (int j = 0; j < 40; ++j) {
            const double z = random.uniform(-3, 3);
            const double outside = outside_by(obstacle, {x, y, z});
            const bool is_within = extent.low < z && z < extent.high;
            inside += is_within;
            if (std::abs(outside) > 1e-9) {
                REQUIRE(is_within == (outside < 0));
            }
        }
        if (!extent.empty()) {
            CHECK(std::abs(outside_by(obstacle, {x, y, extent.low})) < 1e-9);
            CHECK(std::abs(outside_by(obstacle, {x, y, extent.high})) < 1e-9);
        }
    }
    CHECK(inside > 3000);
}

TEST_CASE("A horizontal line is in the shadow exactly where vertical lines meet the obstacle") {
    test::Random random(2);
    int shaded = 0;
    for (int i = 0; i < 2000; ++i) {
        const Scene scene({any_obstacle(random)});
        const double px = random.uniform(-2, 2);
        const double py = random.uniform(-2, 2);
        const double angle = i % 3 == 0 ? quarter_turn * random.integer(0, 3) : random.uniform(-3, 3);
        const double dx = std::cos(angle);
        const double dy = std::sin(angle);
        const Interval shadow = scene.shadow_on_line(0, px, py, dx, dy);
        for (int j = 0; j < 40; ++j) {
            const double s = random.uniform(-4, 4);
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

TEST_CASE("Vertical extents and shadows agree with hand values") {
    const double half_turn = 2 * quarter_turn;
    const Scene scene({{"box", Box{{2, 4, 1}}, {1, 2, 3}, {}},
                       {"pipe", Cylinder{0.5, 6, {0, 3, 0}}, {0, 0, 2}, {}},
                       {"post", Cylinder{0.5, 6, {0, 0, 1}}, {0, 0, 0}, {half_turn, 0, 0}},
                       {"leaning", Cylinder{1, 20, {1, 0, 1}}, {0, 0, 0}, {}}});
    const auto is = [](const Interval& interval, double low, double high) {
        return std::abs(interval.low - low) < 1e-12 && std::abs(interval.high - high) < 1e-12;
    };
    CHECK(is(scene.vertical_extent(0, 1.5, 1), 2.5, 3.5));
    CHECK(scene.vertical_extent(0, 2.5, 1).empty());
    CHECK(is(scene.shadow_on_line(0, 0, 0, 0, 1), 0, 4));
    CHECK(is(scene.vertical_extent(1, 0.3, 2), 1.6, 2.4));
    CHECK(is(scene.shadow_on_line(1, 0, 0, 1, 0), -0.5, 0.5));
    CHECK(is(scene.shadow_on_line(1, 0, 0, 0, 1), -3, 3));
    CHECK(is(scene.vertical_extent(2, 0.3, 0.3), -3, 3));
    CHECK(is(scene.shadow_on_line(2, 0, 0, 0.6, 0.8), -0.5, 0.5));
    CHECK(is(scene.vertical_extent(3, 0, 0), -std::sqrt(2.0), std::sqrt(2.0)));
    CHECK(is(scene.shadow_on_line(3, 0, 0, 1, 0), -11 / std::sqrt(2.0), 11 / std::sqrt(2.0)));
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
