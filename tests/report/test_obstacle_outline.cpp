#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "../support/meshes.hpp"
#include "../support/random.hpp"
#include "downwash/report/obstacle_drawing.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "pictures.hpp"

using namespace downwash;
using test::box_mesh;

namespace {

constexpr double pi = 3.14159265358979323846;

ObstacleOutline outline_of(const Shape& shape, const Vector3& center_m = {0, 0, 0}, const Vector3& rpy_rad = {0, 0, 0},
                           const PlaneOfMotion& plane = {}, double lateral_m = 0) {
    const Scene scene({Obstacle{"thing", shape, center_m, rpy_rad}});
    return obstacle_outlines(scene, plane, lateral_m).at(0);
}

double area(const ObstacleOutline& outline) {
    double sum = 0;
    for (const auto& ring : outline.rings) {
        sum += test::area_of(ring);
    }
    return sum;
}

}  // namespace

TEST_CASE("a box is cut in its side view, along its diagonal and in a hexagon") {
    const ObstacleOutline outline = outline_of(Box{{4, 3, 2}}, {10, 1, 5});
    CHECK(outline.name == "thing");
    CHECK(outline.is_cut);
    REQUIRE(outline.rings.size() == 1);
    CHECK(outline.rings[0].size() == 4);
    CHECK(area(outline) == Approx(8));
    for (const PlanePoint& p : outline.rings[0]) {
        CHECK(std::abs(p.x_m - 10) == Approx(2));
        CHECK(std::abs(p.z_m - 5) == Approx(1));
    }
    // Turned by 45 degrees it is cut along its diagonal.
    CHECK(area(outline_of(Box{{1, 1, 3}}, {0, 0, 0}, {0, 0, pi / 4})) == Approx(3 * std::sqrt(2)));
    // A regular hexagon comes out of a cube cut square to its diagonal. Turned so that its diagonal (1, 1, 1) lies
    // along y: roll about x lifts (1, 1, 1) by 45 degrees into (1, sqrt 2, 0), yaw about z then turns that to (0, sqrt
    // 3, 0).
    const ObstacleOutline hexagon = outline_of(Box{{1, 1, 1}}, {0, 0, 0}, {-pi / 4, 0, std::atan(1 / std::sqrt(2.0))});
    REQUIRE(hexagon.rings.size() == 1);
    CHECK(hexagon.rings[0].size() == 6);
    CHECK(area(hexagon) == Approx(3 * std::sqrt(3) / 4));
}

TEST_CASE("a cylinder is cut in a circle, an ellipse and a rectangle, a sphere in a circle") {
    const double polygon = 96 * std::sin(2 * pi / 96) / 2;  // of the unit circle
    CHECK(area(outline_of(Cylinder{0.5, 4, {0, 1, 0}})) == Approx(0.25 * polygon));
    CHECK(area(outline_of(Cylinder{0.5, 4, {0, 0, 2}})) == Approx(4).epsilon(1e-3));
    // Oblique by 60 degrees: an ellipse, twice as long as wide.
    CHECK(area(outline_of(Cylinder{0.5, 40, {std::sqrt(3), 1, 0}})) == Approx(2 * 0.25 * pi).epsilon(2e-3));
    // A sphere is cut in a circle that shrinks towards its side.
    const ObstacleOutline outline = outline_of(Sphere{0.5}, {0, 0.3, 0});
    CHECK(outline.is_cut);
    for (const PlanePoint& p : outline.rings.at(0)) {
        CHECK(std::hypot(p.x_m, p.z_m) == Approx(0.4));
    }
}

TEST_CASE("what the plane misses is projected") {
    const ObstacleOutline box = outline_of(Box{{4, 1, 2}}, {0, 2, 0});
    CHECK_FALSE(box.is_cut);
    CHECK(area(box) == Approx(8));
    const ObstacleOutline sphere = outline_of(Sphere{0.5}, {0, 0.6, 0});
    CHECK_FALSE(sphere.is_cut);
    CHECK(area(sphere) == Approx(0.25 * pi).epsilon(1e-3));
    CHECK(outline_of(Box{{4, 1, 2}}, {0, 2, 0}, {0, 0, 0}, {}, 1.8).is_cut);
}

TEST_CASE("cross sections move with scene and plane") {
    test::Random random(3);
    for (int i = 0; i < 50; ++i) {
        const Vector3 center{random.uniform(-3, 3), random.uniform(-0.3, 0.3), random.uniform(-3, 3)};
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        const std::vector<Shape> shapes{Box{{1, 2, 3}}, Cylinder{0.7, 2, {1, 2, 3}}};
        const Shape& shape = shapes[static_cast<std::size_t>(i % 2)];
        const PlaneOfMotion moved({5, -7, 2}, random.uniform(-3, 3));
        const ObstacleOutline here = outline_of(shape, center, rpy);
        const Vector3 there_m = moved.to_world(center[0], center[1], center[2]);
        const ObstacleOutline there = outline_of(shape, there_m, {rpy[0], rpy[1], rpy[2] + moved.heading_rad()}, moved);
        CHECK(here.is_cut == there.is_cut);
        CHECK(area(here) == Approx(area(there)).epsilon(1e-9));
    }
}

TEST_CASE("a mesh of a box has the box's cross section, whatever the pose") {
    test::Random random(4);
    for (int i = 0; i < 50; ++i) {
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        const ObstacleOutline outline = outline_of(box_mesh({1, 2, 3}), {0.1, 0.2, 0.3}, rpy);
        REQUIRE(outline.rings.size() == 1);
        CHECK(outline.lines.empty());
        CHECK(area(outline) == Approx(area(outline_of(Box{{1, 2, 3}}, {0.1, 0.2, 0.3}, rpy))));
    }
}

TEST_CASE("corners that a mesh repeats for each triangle are one, and cavities run the other way round") {
    const Mesh shared = test::joined(box_mesh({4, 4, 4}), test::reversed(box_mesh({2, 2, 2})));
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [i, j, k] : shared.surface->triangles) {
        const auto& v = shared.surface->vertices_m;
        triangles.push_back({v[i], v[j], v[k]});
    }
    for (const Mesh& mesh : {shared, test::soup_of(triangles)}) {
        const ObstacleOutline outline = outline_of(mesh, {0, 0.3, 0});
        REQUIRE(outline.rings.size() == 2);
        CHECK(area(outline) == Approx(16 - 4));
    }
}

TEST_CASE("parts of a mesh beside the plane are projected, where the plane cuts others") {
    // A deck that the plane cuts, and two girders below it, one of which touches it along an edge.
    const Mesh deck = test::moved(box_mesh({4, 2, 1}), {0, 0, 3});
    const Mesh left = test::moved(box_mesh({4, 0.2, 1}), {0, 0.9, 2});
    const Mesh right = test::moved(box_mesh({3, 0.2, 0.5}), {0, -0.8, 2});
    const Mesh bay = test::joined(test::joined(deck, left), right);
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [i, j, k] : bay.surface->triangles) {
        const auto& v = bay.surface->vertices_m;
        triangles.push_back({v[i], v[j], v[k]});
    }
    for (const Mesh& mesh : {bay, test::soup_of(triangles)}) {
        const ObstacleOutline outline = outline_of(mesh);
        CHECK(outline.is_cut);
        CHECK(area(outline) == Approx(4));
        REQUIRE(outline.beside.size() == 2);
        ObstacleOutline beside;
        beside.rings = {outline.beside[0]};
        const double one = std::abs(area(beside));
        beside.rings = {outline.beside[1]};
        CHECK(one + std::abs(area(beside)) == Approx(4 + 1.5));
        const auto drawn = visible_outlines({outline}, {-5, 5, -5, 5});
        REQUIRE(drawn.size() == 2);
        CHECK_FALSE(drawn[1].outline.is_cut);
        CHECK(drawn[1].outline.name.empty());
        CHECK(drawn[1].edges.size() >= 2);
    }
    CHECK(outline_of(deck, {0, 5, 0}).beside.empty());  // as a whole it is beside
}

TEST_CASE("a sheet is cut in an open line, an octree cube by cube") {
    const ObstacleOutline outline =
        outline_of(test::mesh_of({{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
    CHECK(outline.is_cut);
    CHECK(outline.rings.empty());
    REQUIRE(outline.lines.size() == 1);
    CHECK(outline.lines[0].size() == 3);
    CHECK(std::abs(outline.lines[0].front().x_m - outline.lines[0].back().x_m) == Approx(4));
    const auto tree =
        std::make_shared<const OccupancyTree>(OccupancyTree{0.5, {{{0, 0, 0}, 0.5}, {{3, 0.1, 0}, 1}, {{0, 5, 0}, 1}}});
    const ObstacleOutline cubes = outline_of(Octomap{"", tree});
    CHECK(cubes.is_cut);
    CHECK(cubes.rings.size() == 2);
    CHECK(area(cubes) == Approx(0.25 + 1));
    CHECK_FALSE(outline_of(Octomap{"", tree}, {0, 20, 0}).is_cut);
    OccupancyTree scan = *tree;
    scan.unseen = {{{0, 0, 6}, {2, 0.5, 3}}};
    const auto scanned = std::make_shared<const OccupancyTree>(std::move(scan));
    CHECK(area(outline_of(Octomap{"", scanned})) == Approx(0.25 + 1));
    CHECK(area(outline_of(Octomap{"", scanned, UnknownSpace::occupied})) == Approx(0.25 + 1 + 6));
}
