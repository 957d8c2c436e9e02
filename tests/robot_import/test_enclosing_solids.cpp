#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "../support/scratch_folder.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/robot_import/enclosing_solid.hpp"
#include "downwash/robot_import/robot_import.hpp"
#include "text_edits.hpp"

using namespace downwash;
using namespace downwash::test;
using namespace downwash::robot_import;
using Catch::Contains;

namespace {

using Points = std::vector<Vector3>;

/// How far a point is outside a solid, by its definition; 0 inside.
double outside_m(const SpaceBodyShape& body, const Vector3& point) {
    const Vector3 at = point - body.center_m;
    if (const auto* box = std::get_if<Box>(&body.shape)) {
        double most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            most = std::max(most, std::abs(at[k]) - 0.5 * box->size_m[k]);
        }
        return most;
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&body.shape)) {
        const Vector3 axis = unit(cylinder->axis);
        const double along = dot(at, axis);
        return std::max(
            {0.0, std::abs(along) - 0.5 * cylinder->length_m, length_of(at - along * axis) - cylinder->radius_m});
    }
    if (const auto* sphere = std::get_if<Sphere>(&body.shape)) {
        return std::max(0.0, length_of(at) - sphere->radius_m);
    }
    const auto& capsule = std::get<Capsule>(body.shape);
    const Vector3 way = capsule.to_m - capsule.from_m;
    const double square = dot(way, way);
    const double share = square > 0 ? std::clamp(dot(at - capsule.from_m, way) / square, 0.0, 1.0) : 0.0;
    return std::max(0.0, length_of(at - capsule.from_m - share * way) - capsule.radius_m);
}

void check_holds(const EnclosingSolid& solid, const Points& points) {
    double most = 0;
    for (const Vector3& point : points) {
        most = std::max(most, outside_m(solid.body, point));
    }
    CHECK(most < 1e-12);
}

/// Points on the rim of a tube's ends.
Points tube(const Vector3& from, const Vector3& to, double radius_m, int corners) {
    const Vector3 axis = unit(to - from), one = across(axis), other = cross(axis, one);
    Points points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const Vector3 rim = radius_m * (std::cos(angle) * one + std::sin(angle) * other);
        points.push_back(from + rim);
        points.push_back(to + rim);
    }
    return points;
}

/// A cloud of points with the sizes of a box.
Points cloud(std::mt19937_64& generator, std::size_t count, const Vector3& size) {
    std::normal_distribution<double> normal;
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back({size[0] * normal(generator), size[1] * normal(generator), size[2] * normal(generator)});
    }
    return points;
}

}  // namespace

TEST_CASE("the least solid around a tube that is askew is that tube as a cylinder") {
    const Vector3 from{0.1, -0.2, 0.3}, to{0.4, 0.1, 0.05};
    const Points points = tube(from, to, 0.02, 24);
    const EnclosingSolid solid = least_solid_around(points);
    check_holds(solid, points);
    REQUIRE(std::holds_alternative<Cylinder>(solid.body.shape));
    const auto& cylinder = std::get<Cylinder>(solid.body.shape);
    CHECK(cylinder.radius_m == Approx(0.02).epsilon(0.01));
    CHECK(cylinder.length_m == Approx(length_of(to - from)).epsilon(0.01));
    CHECK(std::abs(dot(unit(cylinder.axis), unit(to - from))) == Approx(1).margin(1e-4));
    CHECK(solid.excess_m < 1e-3);
}

TEST_CASE("boxes, balls and rods with round ends become what they are") {
    Points box;
    for (int i = 0; i < 8; ++i) {
        box.push_back({i & 1 ? 0.2 : 0.0, i & 2 ? 0.1 : 0.0, i & 4 ? 0.3 : 0.0});
    }
    const EnclosingSolid of_box = least_solid_around(box);
    REQUIRE(std::holds_alternative<Box>(of_box.body.shape));
    CHECK(std::get<Box>(of_box.body.shape).size_m == Vector3{0.2, 0.1, 0.3});
    CHECK(of_box.excess_m == Approx(0).margin(1e-12));

    Points ball, rod;
    for (int i = 0; i < 2000; ++i) {
        const double z = 1 - (2 * i + 1) / 2000.0, angle = 2.399963229728653 * i, across_m = std::sqrt(1 - z * z);
        const Vector3 at{across_m * std::cos(angle), across_m * std::sin(angle), z};
        ball.push_back(0.3 * at);
        // Its axis is that of x + z.
        const double side = at[0] + at[2] > 0 ? 0.5 : -0.5;
        rod.push_back(0.1 * at + side * Vector3{std::sqrt(0.5), 0, std::sqrt(0.5)});
    }
    const EnclosingSolid of_ball = least_solid_around(ball), of_rod = least_solid_around(rod);
    check_holds(of_ball, ball);
    REQUIRE(std::holds_alternative<Sphere>(of_ball.body.shape));
    CHECK(std::get<Sphere>(of_ball.body.shape).radius_m == Approx(0.3).epsilon(0.005));
    check_holds(of_rod, rod);
    REQUIRE(std::holds_alternative<Capsule>(of_rod.body.shape));
    CHECK(volume_m3(of_rod.body.shape) == Approx(volume_m3(Capsule{0.1, {-0.5, 0, 0}, {0.5, 0, 0}})).epsilon(0.02));
}

TEST_CASE("of fifty clouds of points every solid holds all, and is no larger than the box around them") {
    std::mt19937_64 generator(11);
    std::uniform_real_distribution<double> size(0.01, 1);
    for (int i = 0; i < 50; ++i) {
        const Points points =
            cloud(generator, i % 2 == 0 ? 30 : 900, {size(generator), size(generator), size(generator)});
        const EnclosingSolid solid = least_solid_around(points);
        check_holds(solid, points);
        const BoundingBox bounds = bounds_around(points);
        CHECK(volume_m3(solid.body.shape) <= volume_m3(Box{bounds.high_m - bounds.low_m}) * (1 + 1e-12));
        CHECK(solid.excess_m > 0);
    }
}

TEST_CASE("sheets and lines of points get the thickness of a millimetre") {
    const Points sheet{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.1, 0}, {0, 0.1, 0}}, line{{0, 0, 0}, {0.1, 0.1, 0.1}};
    check_holds(least_solid_around(sheet), sheet);
    check_holds(least_solid_around(line), line);
    CHECK(volume_m3(least_solid_around(sheet).body.shape) == Approx(0.2 * 0.1 * 1e-3));
    CHECK(volume_m3(least_solid_around(line).body.shape) > 0);
    check_holds(least_solid_around({{1, 2, 3}}), {{1, 2, 3}});
}

TEST_CASE(
    "a mesh becomes the least solid around it, in the place of the link, with a warning of how much larger it is") {
    const ScratchFolder folder;
    // A tube along x in millimetres, as triangles without thought for which way they face.
    const Points points = tube({-80, 0, 0}, {80, 0, 0}, 30, 16);
    std::string solid = "solid tube\n";
    for (std::size_t i = 0; i + 2 < points.size(); ++i) {
        solid += "facet normal 0 0 0\nouter loop\n";
        for (std::size_t k = i; k < i + 3; ++k) {
            solid += "vertex " + std::to_string(points[k][0]) + " " + std::to_string(points[k][1]) + " " +
                     std::to_string(points[k][2]) + "\n";
        }
        solid += "endloop\nendfacet\n";
    }
    write_text(folder / "battery.stl", solid + "endsolid tube\n");
    write_text(
        folder / "robot.urdf",
        edited(text_of(DOWNWASH_MODELS "/hexa_arm2.urdf"),
               {{"<box size=\"0.16 0.06 0.05\"/>", "<mesh filename=\"battery.stl\" scale=\"0.001 0.001 0.001\"/>"}}));
    const ImportedRobot imported = import_robot(folder / "robot.urdf");
    REQUIRE(std::holds_alternative<Cylinder>(imported.robot.body[1].shape));
    const auto& cylinder = std::get<Cylinder>(imported.robot.body[1].shape);
    CHECK(cylinder.radius_m == Approx(0.03).epsilon(1e-6));
    CHECK(cylinder.length_m == Approx(0.16).epsilon(1e-6));
    // The battery is turned by a quarter about z.
    CHECK(std::abs(cylinder.axis[1]) == Approx(1).margin(1e-9));
    REQUIRE(imported.warnings.size() == 1);
    CHECK_THAT(
        imported.warnings[0].message,
        Contains("has the mesh '") && Contains("battery.stl': taken is the cylinder around it, which stands out from "
                                               "its convex hull by up to 0.0"));
}

namespace {

/// Boxes of an STL in ASCII, two triangles for each of their faces.
std::string stl_of(const std::vector<std::pair<Vector3, Vector3>>& boxes) {
    constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::string text = "solid boxes\n";
    for (const auto& [low, high] : boxes) {
        const auto vertex = [&](int i) {
            return "vertex " + std::to_string(i & 1 ? high[0] : low[0]) + " " +
                   std::to_string(i & 2 ? high[1] : low[1]) + " " + std::to_string(i & 4 ? high[2] : low[2]) + "\n";
        };
        for (const auto& face : faces) {
            for (const auto& [a, b] : {std::pair{1, 2}, std::pair{2, 3}}) {
                text += "facet normal 0 0 0\nouter loop\n" + vertex(face[0]) + vertex(face[a]) + vertex(face[b]) +
                        "endloop\nendfacet\n";
            }
        }
    }
    return text + "endsolid boxes\n";
}

/// The robot with the battery as such an STL in millimetres.
ImportedRobot with_battery(const std::vector<std::pair<Vector3, Vector3>>& boxes, const TextEdits& edits = {}) {
    const ScratchFolder folder;
    write_text(folder / "battery.stl", stl_of(boxes));
    TextEdits all = {
        {"<box size=\"0.16 0.06 0.05\"/>", "<mesh filename=\"battery.stl\" scale=\"0.001 0.001 0.001\"/>"}};
    all.insert(all.end(), edits.begin(), edits.end());
    write_text(folder / "robot.urdf", edited(text_of(DOWNWASH_MODELS "/hexa_arm2.urdf"), all));
    return import_robot(folder / "robot.urdf");
}

}  // namespace

TEST_CASE("each separate piece of a mesh becomes a solid, and the space between them stays free") {
    const std::size_t alone = with_battery({{{-80, -30, -25}, {80, 30, 25}}}).robot.body.size();
    const ImportedRobot apart =
        with_battery({{{-80, -30, -25}, {-60, 30, 25}}, {{60, -30, -25}, {80, 30, 25}}, {{-5, -5, -25}, {5, 5, 25}}});
    REQUIRE(apart.robot.body.size() == alone + 2);
    double volume = 0;
    for (std::size_t i = 1; i <= 3; ++i) {
        volume += volume_m3(apart.robot.body[i].shape);
    }
    CHECK(volume == Approx(2 * 0.02 * 0.06 * 0.05 + 0.01 * 0.01 * 0.05).epsilon(1e-6));
    REQUIRE(apart.warnings.size() == 1);
    CHECK_THAT(apart.warnings[0].message, Contains("of 3 separate pieces: taken are 3 solids around them"));
}

TEST_CASE("pieces of a mesh within others and beside each other share a solid, and there are at most eight") {
    const std::size_t alone = with_battery({{{-80, -30, -25}, {80, 30, 25}}}).robot.body.size();
    CHECK(with_battery({{{-80, -30, -25}, {80, 30, 25}}, {{0, 0, 0}, {3, 3, 3}}, {{80.5, -30, -25}, {100, 30, 25}}})
              .robot.body.size() == alone);
    std::vector<std::pair<Vector3, Vector3>> many;
    for (int i = 0; i < 300; ++i) {
        const double x = 40.0 * i;
        many.push_back({{x, 0, 0}, {x + 1, 10, 10}});
    }
    CHECK(with_battery(many).robot.body.size() == alone + 7);
}

TEST_CASE("an inertia that no body within its mesh can have is a warning") {
    // sqrt(I / m) of 0.0529 m fits in a mesh that ends 0.089 m from its middle, sqrt(0.05 / 0.5) m does not.
    const std::vector<std::pair<Vector3, Vector3>> mesh{{{-80, -30, -25}, {80, 30, 25}}};
    const auto warns = [](const ImportedRobot& imported) {
        return std::ranges::any_of(imported.warnings, [](const auto& warning) {
            return warning.message.find("has more inertia than its whole mass at the farthest point") !=
                   std::string::npos;
        });
    };
    CHECK(!warns(with_battery(mesh)));
    CHECK(warns(with_battery(mesh, {{"ixx=\"0.0004\" ixy=\"0\" ixz=\"0\" iyy=\"0.0013\" iyz=\"0\" izz=\"0.0014\"",
                                     "ixx=\"0.04\" ixy=\"0\" ixz=\"0\" iyy=\"0.05\" iyz=\"0\" izz=\"0.05\""}})));
}
