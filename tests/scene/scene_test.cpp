#include "downwash/scene/scene.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/error_of.hpp"
#include "reference.hpp"

using namespace downwash;

TEST_CASE("A scene reports every unusable size, axis and pose at once") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::string> keys = test::wrong_keys([&] {
        return Scene({{"good", Box{{1, 1, 1}}, {}, {}},
                      {"flat", Box{{1, 0, 1}}, {}, {}},
                      {"pipe", Cylinder{-1, nan, {0, 0, 0}}, {nan, 0, 0}, {}},
                      {"ball", Sphere{1.0 / 0.0}, {}, {0, 1e9, nan}}});
    });
    CHECK(keys == std::vector<std::string>{"obstacles[1].box.size_m", "obstacles[2].cylinder.radius_m",
                                           "obstacles[2].cylinder.length_m", "obstacles[2].cylinder.axis",
                                           "obstacles[2].center_m", "obstacles[3].sphere.radius_m",
                                           "obstacles[3].rpy_rad"});
}

TEST_CASE("A scene keeps its obstacles in the order given, also when moved") {
    Scene scene({{"a", Sphere{1}, {1, 2, 3}, {}}, {"b", Box{{1, 2, 3}}, {}, {}}});
    const Scene moved = std::move(scene);
    REQUIRE(moved.obstacles().size() == 2);
    CHECK(moved.obstacles()[0].name == "a");
    CHECK(moved.obstacles()[1].name == "b");
    CHECK(moved.bounds(0).low_m == Vector3{0, 1, 2});
    CHECK(Scene({}).obstacles().empty());
}

TEST_CASE("Rolled, pitched and yawed boxes are bounded as computed by hand") {
    const double quarter = 1.57079632679489661923;
    // Roll turns the lengths (2, 4, 6) into (2, 6, 4), pitch then into (4, 6, 2), yaw then into (6, 4, 2).
    const Scene scene({{"", Box{{2, 4, 6}}, {10, 20, 30}, {quarter, quarter, quarter}},
                       {"", Box{{2, 2, 1}}, {0, 0, 0}, {0, 0, quarter / 2}},
                       {"", Cylinder{1, 6, {0, 0, 5}}, {0, 0, 0}, {0, quarter, 0}}});
    const double diagonal = std::sqrt(2.0);
    const std::vector<BoundingBox> expected{{{7, 18, 29}, {13, 22, 31}},
                                            {{-diagonal, -diagonal, -0.5}, {diagonal, diagonal, 0.5}},
                                            {{-3, -1, -1}, {3, 1, 1}}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(scene.bounds(i).low_m[k] == Approx(expected[i].low_m[k]).margin(1e-14));
            CHECK(scene.bounds(i).high_m[k] == Approx(expected[i].high_m[k]).margin(1e-14));
        }
    }
}

TEST_CASE("Bounds hold every point of an obstacle and touch it on all six sides") {
    reference::Dice dice(1);
    for (int round = 0; round < 200; ++round) {
        const Scene scene(dice.obstacles(1));
        const reference::Solid solid = reference::solid_of(scene.obstacles()[0]);
        const BoundingBox& bounds = scene.bounds(0);
        for (int i = 0; i < 100; ++i) {
            const Vector3 point = reference::project(solid, dice.vector(-5, 5));
            for (std::size_t k = 0; k < 3; ++k) {
                REQUIRE(point[k] >= bounds.low_m[k] - 1e-14);
                REQUIRE(point[k] <= bounds.high_m[k] + 1e-14);
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            // Far outside, the nearest point of the solid is its farthest in that direction, nearly.
            Vector3 far = solid.center_m;
            far[k] = 1e9;
            REQUIRE(reference::project(solid, far)[k] == Approx(bounds.high_m[k]).margin(1e-6));
            far[k] = -1e9;
            REQUIRE(reference::project(solid, far)[k] == Approx(bounds.low_m[k]).margin(1e-6));
        }
    }
}
