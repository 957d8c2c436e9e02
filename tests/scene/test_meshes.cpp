// Triangle meshes as obstacles.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/error_of.hpp"
#include "../support/meshes.hpp"
#include "downwash/scene/mesh_remarks.hpp"
#include "downwash/scene/mesh_sides.hpp"
#include "reference.hpp"

using namespace downwash;
using reference::about;
using reference::checker_of;
using test::box_mesh;
using test::first_triangles;
using test::joined;
using test::mesh_of;
using test::moved;
using test::reversed;
using test::soup_of;

namespace {

/// A ball of 0.1 m with an arm of 0.1 m inside of it.
RobotShape ball() {
    return {{{Sphere{0.1}, {}}}, 0, 0, 0.05, 0.02};
}

/// A triangle with corners in a cube of 4 m.
std::array<Vector3, 3> some_corners(reference::Dice& dice) {
    const Vector3 around = dice.vector(-1.5, 1.5);
    std::array<Vector3, 3> corners{};
    for (Vector3& corner : corners) {
        const Vector3 step = dice.vector(-0.5, 0.5);
        corner = {around[0] + step[0], around[1] + step[1], around[2] + step[2]};
    }
    return corners;
}

/// A shell of cubes of 4 m and, inside out, 2 m.
Mesh shell() {
    return joined(box_mesh({4, 4, 4}), reversed(box_mesh({2, 2, 2})));
}

SurfaceKind kind_of(const Mesh& mesh) {
    return sides_of(*mesh.surface).kind;
}

/// Which triangles of a solid have to be turned.
std::vector<bool> turns_of(const Mesh& mesh) {
    const MeshSides sides = sides_of(*mesh.surface);
    CHECK(sides.kind == SurfaceKind::solid);
    return sides.is_turned;
}

bool is_solid_as_it_is(const Mesh& mesh) {
    const std::vector<bool> turns = turns_of(mesh);
    return std::none_of(turns.begin(), turns.end(), [](bool is_turned) { return is_turned; });
}

/// With some triangles the other way around.
Mesh with_turned(const Mesh& mesh, const std::vector<std::size_t>& triangles) {
    return test::edited(mesh, [&triangles](TriangleMesh& surface) {
        for (const std::size_t i : triangles) {
            std::swap(surface.triangles[i][0], surface.triangles[i][2]);
        }
    });
}

/// And one more triangle that has shrunk to an edge.
Mesh with_edge(const Mesh& mesh) {
    return test::edited(mesh, [](TriangleMesh& surface) { surface.triangles.push_back({0, 0, 1}); });
}

/// The flags of `count` triangles of which some have to be turned.
std::vector<bool> flags(std::size_t count, const std::vector<std::size_t>& turned) {
    std::vector<bool> all(count);
    for (const std::size_t i : turned) {
        all[i] = true;
    }
    return all;
}

std::string error_in(const Mesh& mesh) {
    return test::error_of([&] { return Scene({{"", Sphere{1}, {}, {}}, {"", mesh, {}, {}}}); });
}

}  // namespace

TEST_CASE("Meshes that cannot stand in a scene are errors with their place") {
    using Catch::Matchers::Contains;
    const Vector3 a{0, 0, 0};
    const Vector3 b{1, 0, 0};
    const Vector3 c{0, 1, 0};
    CHECK(error_in(mesh_of({a, b, c}, {{0, 1, 2}})) == "none");
    CHECK_THAT(error_in({}), Contains("obstacles[1].mesh.file: must have been read"));
    CHECK_THAT(error_in(mesh_of({a, b, c}, {})), Contains("obstacles[1].mesh.file: has no triangle with an area"));
    CHECK_THAT(error_in(mesh_of({a, b, c}, {{0, 1, 3}})), Contains("a corner that is not among its vertices"));
    CHECK_THAT(error_in(mesh_of({a, b, {2, 0, 0}}, {{0, 1, 2}, {0, 1, 1}})), Contains("no triangle with an area"));
    CHECK_THAT(error_in(mesh_of({a, b, {0, std::nan(""), 0}}, {{0, 1, 2}})),
               Contains("has the corner [0, nan, 0], which is not finite"));
    CHECK_THAT(error_in(mesh_of({a, b, {0, 2e6, 0}}, {{0, 1, 2}})), Contains("farther than 1e6 m"));
    Mesh scaled = mesh_of({a, b, c}, {{0, 1, 2}});
    for (const double scale : {0.0, -1.0, std::nan(""), 1.0 / 0.0}) {
        scaled.scale = scale;
        CHECK_THAT(error_in(scaled), Contains("obstacles[1].mesh.scale: must be a finite number above 0"));
    }
    const std::vector<std::array<std::uint32_t, 3>> many(1'100'000, {0, 1, 2});
    CHECK_THAT(error_in(joined(mesh_of({a, b, c}, many), mesh_of({a, b, c}, many))),
               Contains("has 2200000 triangles: at most 2000000"));
    const Mesh half = mesh_of({a, b, c}, {many.begin(), many.begin() + 1'000'001});
    CHECK_THROWS_WITH(Scene({{"", half, {}, {}}, {"", half, {}, {}}}), Contains("above 2000000"));
}

TEST_CASE("A sheet that is there twice encloses nothing, a thin plate does") {
    const std::vector<Vector3> corners{{0, 0, 5}, {4, 0, 5}, {4, 4, 5}, {0, 4, 5}};
    // One diagonal above, the other below.
    const Mesh doubled = mesh_of(corners, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
    CHECK(kind_of(doubled) == SurfaceKind::sheet);
    const SurfaceFacts facts = sides_of(*doubled.surface).facts;
    CHECK(facts.pieces == 1);
    CHECK(facts.solid_pieces == 0);
    CHECK(facts.open_edges == 0);
    CHECK(kind_of(box_mesh({100, 100, 1e-4})) == SurfaceKind::solid);
    CHECK(kind_of(box_mesh({100, 0.01, 0.01})) == SurfaceKind::solid);
    CHECK(kind_of(joined(doubled, box_mesh({1, 1, 1}))) == SurfaceKind::mixed);
    // Two tetrahedra that meet at a corner, one of them inside out: together they have no volume.
    const Mesh two = mesh_of({{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {0, 0, 1}, {-1, 0, -1}, {0, -1, -1}, {0, 0, -1}},
                             {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}});
    CHECK(kind_of(two) == SurfaceKind::solid);
}

TEST_CASE("Edges of walls that two rooms share, and steps of single precision, are told") {
    const Mesh box = box_mesh({1, 1, 1});
    CHECK(shared_edges(*box.surface) == 0);
    CHECK(shared_edges(*first_triangles(box, 11).surface) == 0);
    // Three leaves of a book.
    const Mesh book =
        mesh_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
    CHECK(shared_edges(*book.surface) == 1);
    CHECK(single_precision_step(*moved(box, {5'334'567, 0, 0}).surface) == 0.5);
    CHECK(single_precision_step(*moved(box, {5'334'567.1, 0, 0}).surface) == 0);
}

TEST_CASE("A surface is closed when every edge is gone through both ways") {
    const Mesh box = box_mesh({1, 2, 3});
    CHECK(is_solid_as_it_is(box));
    CHECK(is_solid_as_it_is(reversed(box)));
    CHECK(kind_of(first_triangles(box, 11)) == SurfaceKind::sheet);
    SECTION("corners of their own for each triangle are joined where they meet") {
        std::vector<std::array<Vector3, 3>> all;
        for (const auto& t : box.surface->triangles) {
            const auto& v = box.surface->vertices_m;
            all.push_back({v[t[0]], v[t[1]], v[t[2]]});
        }
        CHECK(is_solid_as_it_is(soup_of(all)));
    }
    SECTION("zero has two signs and one place") {
        const Mesh tetrahedron =
            mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {1, -0.0, 0}, {-0.0, 1, 0}, {0, 0, 1}},
                    {{0, 2, 1}, {3, 4, 6}, {4, 5, 6}, {5, 3, 6}});
        CHECK(is_solid_as_it_is(tetrahedron));
    }
    SECTION("triangles that have shrunk to an edge leave no hole") {
        CHECK(is_solid_as_it_is(with_edge(box)));
    }
    SECTION("boxes that touch along an edge") {
        CHECK(is_solid_as_it_is(joined(box, moved(box, {1, 2, 0}))));
    }
}

TEST_CASE("Triangles that are the wrong way around are turned, the fewest possible") {
    using Catch::Matchers::Equals;
    const Mesh box = box_mesh({1, 2, 3});
    for (std::size_t wrong = 0; wrong < 12; ++wrong) {
        CHECK_THAT(turns_of(with_turned(box, {wrong})), Equals(flags(12, {wrong})));
        CHECK_THAT(turns_of(with_turned(reversed(box), {wrong})), Equals(flags(12, {wrong})));
    }
    SECTION("a cavity stays one") {
        CHECK_THAT(turns_of(with_turned(shell(), {3, 14, 20})), Equals(flags(24, {3, 14, 20})));
        CHECK(sides_of(*with_turned(shell(), {3, 14, 20}).surface).most_turned == Approx(2. / 12));
        CHECK(sides_of(*shell().surface).most_turned == 0);
    }
    SECTION("a triangle that has shrunk to an edge does not part its neighbours") {
        CHECK_THAT(turns_of(with_edge(with_turned(box, {0}))), Equals(flags(13, {0})));
    }
    SECTION("boxes that touch along an edge") {
        const Mesh both = joined(box, reversed(moved(box, {1, 2, 0})));
        for (std::size_t wrong = 0; wrong < 24; ++wrong) {
            CHECK_THAT(turns_of(with_turned(both, {wrong})), Equals(flags(24, {wrong})));
        }
    }
}

TEST_CASE("A surface without a rim that has no outside is an error") {
    using Catch::Matchers::Contains;
    // The projective plane: an icosahedron whose opposite corners are one. Every edge has two triangles.
    const Mesh one_sided = mesh_of(
        {{0, 0, 1}, {1, 0, 0}, {0.3, 1, 0}, {-0.8, 0.6, 0}, {-0.8, -0.6, 0}, {0.3, -1, 0}},
        {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}});
    CHECK(kind_of(one_sided) == SurfaceKind::contradictory);
    CHECK_THAT(error_in(one_sided), Contains("obstacles[1].mesh.file: has triangles that disagree about which side"));
    // Where more than two triangles meet nothing tells which of them is wrong.
    const std::vector<Vector3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    // As often one way as the other, they are the two sides of one.
    CHECK(kind_of(mesh_of(corners, {{0, 1, 2}, {0, 2, 1}, {0, 1, 2}, {0, 2, 1}})) == SurfaceKind::sheet);
    CHECK(kind_of(mesh_of(corners, {{0, 1, 2}, {0, 2, 1}, {0, 1, 2}, {0, 1, 2}})) == SurfaceKind::contradictory);
    // A strip with half a turn has a rim.
    const Mesh moebius =
        mesh_of(one_sided.surface->vertices_m, {{1, 2, 3}, {2, 3, 4}, {3, 4, 5}, {4, 5, 1}, {5, 1, 2}});
    CHECK(kind_of(moebius) == SurfaceKind::sheet);
    CHECK(error_in(moebius) == "none");
}

TEST_CASE("A box of triangles is as near as the same box as a primitive, from outside and from inside") {
    reference::Dice dice(31);
    int inside = 0;
    for (int round = 0; round < 300; ++round) {
        const Obstacle box{"", Box{dice.vector(0.1, 3)}, dice.vector(-1, 1), dice.vector(-4, 4)};
        Obstacle mesh = box;
        mesh.shape = box_mesh(std::get<Box>(box.shape).size_m);
        CAPTURE(round);
        inside += reference::contacts_of_equals({mesh}, {box}, dice);
    }
    CHECK(inside > 500);
}

TEST_CASE("Triangles are as far away as alternating projections say") {
    reference::Dice dice(32);
    int undecided = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<std::array<Vector3, 3>> corners;
        std::vector<reference::Solid> solids;
        for (int i = 0; i < 3; ++i) {
            corners.push_back(some_corners(dice));
            solids.push_back(reference::triangle(corners.back()));
        }
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const PlanarPose pose = dice.pose();
        const reference::Enclosure truth = reference::clearance(reference::robot_at(pose, plane, robot), solids);
        undecided += truth.high - truth.low > 1e-6;
        const double clearance = checker_of({{"", soup_of(corners), {}, {}}}, robot, plane).clearance_m(pose);
        CAPTURE(round, clearance, truth.low, truth.high);
        REQUIRE(truth.holds(clearance));
    }
    CHECK(undecided < 15);
}

TEST_CASE("Among thousands of triangles the nearest is found") {
    reference::Dice dice(33);
    std::vector<std::array<Vector3, 3>> corners;
    for (int i = 0; i < 3000; ++i) {
        corners.push_back(some_corners(dice));
        for (Vector3& corner : corners.back()) {  // small ones, in a ball of space around the robot's
            const Vector3& c = corners.back()[0];
            corner = {c[0] + 0.05 * (corner[0] - c[0]), c[1] + 0.05 * (corner[1] - c[1]),
                      c[2] + 0.05 * (corner[2] - c[2])};
        }
    }
    const RobotShape robot{{{Box{{0.1, 0.1, 0.02}}, {}}}, 0, 0, 0.1, 0.01};
    const CollisionChecker checker = checker_of({{"", soup_of(corners), {}, {}}}, robot);
    std::vector<CollisionChecker> single;
    for (const auto& triangle : corners) {
        single.push_back(checker_of({{"", soup_of({triangle}), {}, {}}}, robot));
    }
    int apart = 0;
    for (int i = 0; i < 40; ++i) {
        const PlanarPose pose = dice.pose();
        double least = std::numeric_limits<double>::infinity();
        for (const CollisionChecker& one : single) {
            least = std::min(least, one.clearance_m(pose));
        }
        const double clearance = checker.clearance_m(pose);
        CAPTURE(i);
        REQUIRE(std::max(0.0, clearance) == about(std::max(0.0, least)));
        if (clearance > 0) {
            ++apart;
            REQUIRE(checker.is_nearer_than(pose, 0.02) == (clearance < 0.02));
        }
    }
    CHECK(apart > 20);
}

TEST_CASE("A body inside a closed mesh is in contact, in its cavity it is not") {
    for (const Mesh& solid : {box_mesh({4, 4, 4}), reversed(box_mesh({4, 4, 4}))}) {
        const CollisionChecker checker = checker_of({{"", solid, {10, 0, 0}, {0.3, 0.2, 0.1}}}, ball());
        CHECK(checker.clearance_m({10.1, 0.2, 0, 0}) <= 0);
        CHECK(checker.is_nearer_than({10.1, 0.2, 0, 0}, 0));
        CHECK(checker.clearance_m({6, 0, 0, 0}) > 1);
        CHECK_FALSE(checker.is_nearer_than({6, 0, 0, 0}, 1));
    }
    const Scene scene({{"", shell(), {}, {}}});
    const CollisionChecker checker = checker_of({{"", shell(), {}, {}}}, ball());
    CHECK(checker.clearance_m({0.2, 0, 0, 0}) == about(0.7));
    CHECK(checker.clearance_m({1.5, 0, 0, 0}) <= 0);
    CHECK(disc_clearance_m(scene, {0, 0, 0.5}, 0.3) == about(0.5));
    CHECK(disc_clearance_m(scene, {0, 0, 1.5}, 0.3) == 0);
    CHECK_FALSE(disc_is_clear(scene, {0, 0, 1.5}, 0.3, 0));
    CHECK(horizontal_clearance_m(scene, {1.5, 0, 0}) == 0);
}

TEST_CASE("A solid mesh stays solid when triangles of it are the wrong way around") {
    reference::Dice dice(36);
    const Mesh pipe = test::pipe_mesh(2, 4, 12, 3);
    for (const Mesh& solid : {box_mesh({4, 4, 4}), reversed(box_mesh({4, 4, 4})), shell(), pipe}) {
        const Scene expected({{"", solid, {}, {0.3, 0.2, 0.1}}});
        std::vector<std::size_t> wrong;
        for (std::size_t i = 0; i < solid.surface->triangles.size(); ++i) {
            if (dice.between(0, 1) < 0.25) {
                wrong.push_back(i);
            }
        }
        REQUIRE_FALSE(wrong.empty());
        const Scene found({{"", with_turned(solid, wrong), {}, {0.3, 0.2, 0.1}}});
        int inside = 0;
        for (int i = 0; i < 500; ++i) {
            const Vector3 p = dice.vector(-3, 3);
            const double distance = disc_clearance_m(expected, p, 0.01);
            // distance_m() of scene/convex.hpp promises 1e-8 m; its search ends at 1e-10. Triangles that were turned
            // are met in another order, and the bounds of a distance close in from another side.
            REQUIRE(disc_clearance_m(found, p, 0.01) == Approx(distance).epsilon(0).margin(1e-9));
            inside += distance == 0;
        }
        CHECK(inside > 50);
    }
}

TEST_CASE("Of two boxes in one mesh both are solid when one is inside out") {
    const Mesh box = box_mesh({2, 2, 2});
    const Mesh both = joined(box, reversed(moved(box, {6, 0, 0})));
    for (const Mesh& mesh : {both, with_turned(both, {0}), with_turned(both, {5, 20})}) {
        const CollisionChecker checker = checker_of({{"", mesh, {}, {}}}, ball());
        CHECK(checker.clearance_m({0, 0, 0, 0}) <= 0);
        CHECK(checker.clearance_m({6, 0, 0, 0}) <= 0);
        CHECK(checker.clearance_m({3, 0, 0, 0}) == about(1.9));
    }
}

TEST_CASE("An open mesh is a sheet: nothing is inside it") {
    CHECK(kind_of(with_turned(first_triangles(box_mesh({4, 4, 4}), 11), {2})) == SurfaceKind::sheet);
    const CollisionChecker checker = checker_of({{"", first_triangles(box_mesh({4, 4, 4}), 11), {}, {}}}, ball());
    CHECK(checker.clearance_m({0, 0, 0, 0}) == about(1.9));
    CHECK_FALSE(checker.is_nearer_than({0, 0, 0, 0}, 1));
}

TEST_CASE("Points are inside a mesh where they are inside its shape, also straight below its corners and edges") {
    reference::Dice dice(34);
    const Mesh pipe = test::pipe_mesh(1, 2, 6, 2);  // a hexagonal prism along y with corners straight above others
    const Scene scene({{"", pipe, {}, {}}});
    const double apothem = std::sqrt(0.75);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        Vector3 p = dice.vector(-1.2, 1.2);
        if (dice.coin()) {  // on the grid of the corners
            p[0] = apothem * std::round(dice.between(-1.2, 1.2));
            p[1] = std::round(p[1]);
        }
        double outside_by = std::abs(p[1]) - 1;
        for (int side = 0; side < 3; ++side) {
            const double angle = (30 + 60 * side) * 3.14159265358979323846 / 180;
            outside_by = std::max(outside_by, std::abs(p[0] * std::sin(angle) + p[2] * std::cos(angle)) - apothem);
        }
        if (std::abs(outside_by) > 1e-12) {
            CAPTURE(p[0], p[1], p[2]);
            REQUIRE((disc_clearance_m(scene, p, 1e-9) == 0) == (outside_by < 1e-9));
            inside += outside_by < 0;
        }
    }
    CHECK(inside > 2000);
}

TEST_CASE("A vertical line meets a triangle at one height, and its shadow is where lines meet it") {
    reference::Dice dice(35);
    const Mesh roof = mesh_of({{0, 0, 1}, {4, 0, 1}, {0, 4, 3}, {0, 0, -1}}, {{0, 1, 2}, {0, 3, 1}});
    const Scene scene({{"", roof, {}, {}}});
    REQUIRE(scene.part_count() == 2);
    CHECK(scene.vertical_extent(0, 1, 1).low == Approx(1.5));
    CHECK(scene.vertical_extent(0, 1, 1).high == scene.vertical_extent(0, 1, 1).low);
    CHECK(scene.vertical_extent(0, 3, 2).empty());
    CHECK(scene.vertical_extent(1, 1, 0).empty());  // upright
    CHECK(scene.shadow_on_line(0, 0, 1, 1, 0).low == Approx(0).margin(1e-15));
    CHECK(scene.shadow_on_line(0, 0, 1, 1, 0).high == Approx(3));
    CHECK(scene.shadow_on_line(0, 5, 1, 0, 1).empty());
    CHECK(scene.shadow_on_line(1, 0, 0, 1, 0).empty());
    CHECK_FALSE(scene.is_level(0));
    CHECK(Scene({{"", box_mesh({1, 1, 1}), {}, {0, 0, 0.7}}}).is_level(0));
    CHECK(scene.bounds(0).low_m == Vector3{0, 0, -1});
    CHECK(scene.bounds(0).high_m == Vector3{4, 4, 3});
    for (int round = 0; round < 300; ++round) {
        const Scene one({{"", soup_of({some_corners(dice)}), dice.vector(-1, 1), dice.vector(-3, 3)}});
        const Vector3 p = dice.vector(-2, 2);
        const double angle = dice.between(0, 6.3);
        const double dx = std::cos(angle);
        const double dy = std::sin(angle);
        const Interval shadow = one.shadow_on_line(0, p[0], p[1], dx, dy);
        for (double s = -4; s < 4; s += 0.037) {
            const bool is_met = !one.vertical_extent(0, p[0] + s * dx, p[1] + s * dy).empty();
            REQUIRE(is_met == (shadow.low <= s && s <= shadow.high));
        }
    }
}

TEST_CASE("A mesh is scaled before it is placed") {
    Mesh small = box_mesh({1, 1, 1});
    small.scale = 3;
    const Scene scene({{"", small, {10, 0, 0}, {}}});
    CHECK(scene.bounds(0).low_m == Vector3{8.5, -1.5, -1.5});
    CHECK(scene.bounds(0).high_m == Vector3{11.5, 1.5, 1.5});
}
