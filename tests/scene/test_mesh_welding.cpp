// Surfaces whose corners differ by rounding, and what of them is solid.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "../support/mesh_bytes.hpp"
#include "../support/meshes.hpp"
#include "../support/random.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/mesh_sides.hpp"
#include "downwash/scene/mesh_welding.hpp"
#include "downwash/scene/obstacle_placement.hpp"

using namespace downwash;
using test::box_mesh;
using test::joined;
using test::mesh_of;
using test::moved;
using test::Random;
using test::reversed;

namespace {

using Soup = std::vector<std::array<Vector3, 3>>;

Soup soup_of(const Mesh& mesh) {
    Soup soup;
    for (const auto& [a, b, c] : mesh.surface->triangles) {
        const auto& v = mesh.surface->vertices_m;
        soup.push_back({v[a], v[b], v[c]});
    }
    return soup;
}

double extent_of(const Soup& soup) {
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const auto& triangle : soup) {
            for (const Vector3& corner : triangle) {
                low = std::min(low, corner[k]);
                high = std::max(high, corner[k]);
            }
        }
        extent = std::max(extent, high - low);
    }
    return extent;
}

/// A closed solid of 12 to 200 triangles: one piece, a hollow one, or two beside each other.
Soup some_solid(Random& random) {
    const auto size = [&] { return random.uniform(0.3, 3); };
    const auto part = [&]() -> Mesh {
        return random.integer(0, 1) == 0
                   ? box_mesh({size(), size(), size()})
                   : test::pipe_mesh(size(), size(), static_cast<std::uint32_t>(random.integer(3, 24)),
                                     static_cast<std::uint32_t>(random.integer(1, 3)));
    };
    const int kind = random.integer(0, 2);
    const Mesh whole = kind == 0   ? part()
                       : kind == 1 ? joined(box_mesh({9, 9, 9}), reversed(part()))
                                   : joined(part(), moved(part(), {12, 1, 2}));
    const Matrix3 rotation = rotation_of({random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)});
    const double scale = std::abs(random.magnitude(-2, 3));
    const Vector3 center{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20)};
    Soup soup = soup_of(whole);
    for (auto& triangle : soup) {
        for (Vector3& corner : triangle) {
            corner = scale * (center + rotation * corner);
        }
    }
    return soup;
}

Soup noisy(Soup soup, double noise, Random& random) {
    for (auto& triangle : soup) {
        for (Vector3& corner : triangle) {
            for (double& x : corner) {
                x += random.uniform(-noise, noise);
            }
        }
    }
    return soup;
}

MeshSides sides_after_joining(const Soup& soup) {
    return sides_of(with_joined_corners(*test::soup_of(soup).surface));
}

double distance(const Vector3& a, const Vector3& b) {
    return std::sqrt(dot(a - b, a - b));
}

MeshSides sides_in_file(const Soup& soup) {
    return sides_of(parse_mesh(test::binary_stl(soup), "a.stl"));
}

}  // namespace

TEST_CASE("Closed solids are closed however their corners are rounded") {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        const Soup solid = some_solid(random);
        const std::size_t pieces = sides_of(*test::soup_of(solid).surface).facts.pieces;
        const double extent = extent_of(solid);
        for (const double share : {0., 1e-9, 1e-6}) {
            const Soup found = noisy(solid, share * extent, random);
            REQUIRE((share == 0 || sides_of(*test::soup_of(found).surface).kind == SurfaceKind::sheet));
            const MeshSides sides = sides_after_joining(found);
            REQUIRE(sides.kind == SurfaceKind::solid);
            REQUIRE(sides.facts.pieces == pieces);
            REQUIRE(sides.facts.solid_pieces == pieces);
            REQUIRE(sides.facts.open_edges == 0);
        }
    }
}

TEST_CASE("Where triangles are missing the open edges are counted, and the place of one is told") {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        const Soup solid = some_solid(random);
        const double extent = extent_of(solid);
        Soup rest = solid;
        std::vector<Vector3> middles;
        const int missing = random.integer(1, 3);
        for (int i = 0; i < missing; ++i) {
            const auto at = rest.begin() + random.integer(0, static_cast<int>(rest.size()) - 1);
            for (std::size_t k = 0; k < 3; ++k) {
                middles.push_back(0.5 * ((*at)[k] + (*at)[(k + 1) % 3]));
            }
            rest.erase(at);
        }
        const MeshSides sides = sides_after_joining(noisy(rest, 1e-6 * extent, random));
        REQUIRE((sides.kind == SurfaceKind::sheet || sides.kind == SurfaceKind::mixed));
        // Two that were neighbours have an edge less each, and those of a tetrahedron's last two close it anew.
        REQUIRE(sides.facts.open_edges >= 3);
        REQUIRE(sides.facts.open_edges <= static_cast<std::size_t>(3 * missing));
        REQUIRE(sides.facts.open_edges % 2 == static_cast<std::size_t>(missing) % 2);
        const double off = std::accumulate(middles.begin(), middles.end(), extent, [&](double least, const Vector3& p) {
            return std::min(least, distance(p, sides.facts.open_place));
        });
        REQUIRE(off < 1e-5 * extent);
    }
}

TEST_CASE("Joining moves no corner of a surface that is closed, and of others only those at open edges") {
    Random random(3);
    const Mesh box = box_mesh({1, 2, 3});
    CHECK(with_joined_corners(*box.surface).vertices_m == box.surface->vertices_m);
    // Beside a box that is open to rounding stands a small closed one, whose corners are nearer than that.
    Soup both = noisy(soup_of(box), 1e-6, random);
    const Soup speck = soup_of(moved(box_mesh({1e-5, 1e-5, 1e-5}), {3, 0, 0}));
    both.insert(both.end(), speck.begin(), speck.end());
    const TriangleMesh found = with_joined_corners(*test::soup_of(both).surface);
    CHECK(sides_of(found).facts.solid_pieces == 2);
    for (std::size_t t = 0; t < speck.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(found.vertices_m[found.triangles[box.surface->triangles.size() + t][k]] == speck[t][k]);
        }
    }
    // No corner moves farther than the distance.
    for (std::size_t i = 0; i < found.vertices_m.size(); ++i) {
        const auto& triangle = both[i / 3];
        REQUIRE(distance(found.vertices_m[i], triangle[i % 3]) <= 4e-5);
    }
}

TEST_CASE("A strip that is narrower than what joins does not vanish") {
    const Mesh strip = mesh_of({{0, 0, 0}, {10, 0, 0}, {10, 1e-5, 0}, {0, 1e-5, 0}}, {{0, 1, 2}, {0, 2, 3}});
    const TriangleMesh found = with_joined_corners(*strip.surface);
    CHECK(found.vertices_m == strip.surface->vertices_m);
    CHECK(sides_of(found).facts.open_edges == 4);
    // Nor does one that is smaller all around, far from everything else.
    const Mesh both = joined(strip, mesh_of({{5, 5, 0}, {5, 5.00001, 0}, {5.00001, 5, 0}}, {{0, 1, 2}}));
    CHECK(with_joined_corners(*both.surface).vertices_m == both.surface->vertices_m);
}

TEST_CASE("Map coordinates in single precision join within their steps") {
    Random random(4);
    // Steps of a float near 5e5 are 1/32 m; a box of 100 m has corners that were rounded one step apart.
    Soup soup = soup_of(moved(box_mesh({100, 60, 40}), {500000, 400000, 300}));
    for (auto& triangle : soup) {
        for (Vector3& corner : triangle) {
            corner[0] += random.integer(-1, 1) * 0.03125;
            corner[1] += random.integer(-1, 1) * 0.03125;
        }
    }
    CHECK(sides_of(*test::soup_of(soup).surface).kind == SurfaceKind::sheet);
    CHECK(sides_in_file(soup).kind == SurfaceKind::solid);
}

TEST_CASE("Every piece of a mesh is a solid or a sheet by itself") {
    const Mesh box = box_mesh({2, 2, 2});
    const Mesh wall = mesh_of({{5, -1, -1}, {5, 1, -1}, {5, 1, 1}, {5, -1, 1}}, {{0, 1, 2}, {0, 2, 3}});
    for (const Mesh& both : {joined(box, wall), joined(wall, box)}) {
        const MeshSides sides = sides_of(*both.surface);
        CHECK(sides.kind == SurfaceKind::mixed);
        CHECK(sides.facts.pieces == 2);
        CHECK(sides.facts.solid_pieces == 1);
        CHECK(sides.facts.open_edges == 4);
        const RobotShape ball{{{Sphere{0.1}, {}}}, 0, 0, 0.05, 0.02};
        const Scene scene({{"", both, {}, {}}});
        CHECK(scene.facts(0).open_edges == 4);
        const auto shared = std::make_shared<const Scene>(scene);
        for (const CollisionCheckerKind kind : {CollisionCheckerKind::own, CollisionCheckerKind::fcl}) {
            const CollisionChecker checker(shared, PlaneOfMotion(), ball, kind);
            CHECK(checker.clearance_m({0, 0, 0, 0}) <= 0);
            CHECK(checker.clearance_m({4, 0, 0, 0}) == Approx(0.9));
            CHECK(checker.clearance_m({6, 0, 0, 0}) == Approx(0.9));
        }
    }
}

TEST_CASE("Triangles that are there twice count once where that makes a solid") {
    const Mesh box = box_mesh({2, 2, 2});
    const auto is_solid = [](const Mesh& mesh) {
        const Scene scene({{"", mesh, {}, {}}});
        return sides_of(*mesh.surface).kind == SurfaceKind::solid &&
               disc_clearance_m(scene, {0.2, 0.1, 0.3}, 0.01) == 0;
    };
    const auto with_more = [&](const std::vector<std::size_t>& triangles, bool is_reversed) {
        return test::edited(box, [&](TriangleMesh& surface) {
            for (const std::size_t i : triangles) {
                surface.triangles.push_back(surface.triangles[i]);
                if (is_reversed) {
                    std::swap(surface.triangles.back()[0], surface.triangles.back()[1]);
                }
            }
        });
    };
    CHECK(is_solid(joined(box, box)));            // every one twice
    CHECK(is_solid(joined(box, reversed(box))));  // every one with two sides
    for (const bool is_reversed : {false, true}) {
        CHECK(is_solid(with_more({3}, is_reversed)));
        CHECK(is_solid(with_more({0, 1, 7, 7}, is_reversed)));
    }
    SECTION("open boxes with two sides are sheets") {
        const Mesh open = test::first_triangles(box, 11);
        const MeshSides sides = sides_of(*joined(open, reversed(open)).surface);
        CHECK(sides.kind == SurfaceKind::sheet);
        CHECK(sides.facts.open_edges == 3);
    }
    SECTION("a wall between two boxes belongs to both") {
        const Mesh both = joined(box, moved(box, {2, 0, 0}));
        const MeshSides sides = sides_of(*both.surface);
        CHECK(sides.kind == SurfaceKind::solid);
        CHECK(std::count(sides.is_repeated.begin(), sides.is_repeated.end(), true) == 0);
        const Scene scene({{"", both, {}, {}}});
        CHECK(disc_clearance_m(scene, {0.2, 0.1, 0.3}, 0.01) == 0);
        CHECK(disc_clearance_m(scene, {2.2, 0.1, 0.3}, 0.01) == 0);
    }
}

TEST_CASE("An inner shell is a cavity if it is oriented against the outer one, else solid") {
    const Mesh outer = box_mesh({4, 4, 4});
    const Mesh inner = box_mesh({2, 2, 2});
    const auto clearance = [](const Mesh& mesh, double x_m) {
        return disc_clearance_m(Scene({{"", mesh, {}, {}}}), {x_m, 0.1, 0.2}, 0.01);
    };
    CHECK(clearance(joined(outer, reversed(inner)), 0) > 0.7);
    CHECK(clearance(joined(outer, reversed(inner)), 1.5) == 0);
    CHECK(clearance(joined(outer, inner), 0) == 0);
    // A cavity with a hole in its wall is no cavity: what it is in is solid.
    const Mesh broken = test::first_triangles(joined(outer, reversed(inner)), 23);
    CHECK(sides_of(*broken.surface).kind == SurfaceKind::mixed);
    CHECK(clearance(broken, 0) == 0);
}
