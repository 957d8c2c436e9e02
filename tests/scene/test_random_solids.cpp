// Solids of every kind as other programs write them: rounded, holed, turned and doubled.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../support/mesh_bytes.hpp"
#include "../support/meshes.hpp"
#include "../support/polygons.hpp"
#include "../support/random.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/mesh_sides.hpp"
#include "downwash/scene/obstacle_placement.hpp"

using namespace downwash;
using test::joined;
using test::length;
using test::mesh_of;
using test::moved;
using test::Random;
using test::Triangle;

namespace {

using Soup = std::vector<Triangle>;

Mesh some_tetrahedron(Random& random) {
    for (;;) {
        std::vector<Vector3> v;
        for (int i = 0; i < 4; ++i) {
            v.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        }
        if (dot(cross(v[1] - v[0], v[2] - v[0]), v[3] - v[0]) < -0.3) {
            return mesh_of(v, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
        }
    }
}

/// Upright, its base a star around the axis.
Mesh some_prism(Random& random) {
    const auto sides = static_cast<std::uint32_t>(random.integer(3, 16));
    std::vector<double> radii(sides);
    std::generate(radii.begin(), radii.end(), [&random] { return random.uniform(0.4, 1); });
    const Mesh pipe = test::reversed(test::pipe_mesh(1, random.uniform(0.3, 2), sides, 1));
    return test::edited(pipe, [&](TriangleMesh& surface) {
        for (std::size_t i = 0; i < 2 * std::size_t{sides}; ++i) {
            surface.vertices_m[i][0] *= radii[i % sides];
            surface.vertices_m[i][2] *= radii[i % sides];
        }
    });
}

/// 20, 80 or 320 triangles.
Mesh icosphere(int divisions) {
    constexpr double g = 1.618033988749895;
    std::vector<Vector3> v{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                           {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<std::array<std::uint32_t, 3>> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int i = 0; i < divisions; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(v.size()));
            if (is_new) {
                v.push_back(0.5 * (v[a] + v[b]));
            }
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b);
            const std::uint32_t bc = middle(b, c);
            const std::uint32_t ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    for (Vector3& vertex : v) {
        vertex = (1 / length(vertex)) * vertex;
    }
    return mesh_of(v, triangles);
}

/// Within two metres of the origin.
Mesh some_part(Random& random) {
    const auto size = [&random] { return random.uniform(0.3, 2); };
    switch (random.integer(0, 3)) {
        case 0:
            return test::box_mesh({size(), size(), size()});
        case 1:
            return some_prism(random);
        case 2:
            return some_tetrahedron(random);
        default:
            return icosphere(random.integer(0, 2));
    }
}

/// One part or up to four: apart from each other, one in the cavity of another, or boxes that share an edge or a
/// corner.
Mesh some_solid(Random& random) {
    switch (random.integer(0, 4)) {
        case 0: {
            const Mesh wall = test::box_mesh({5, 5, 5});
            return joined(wall, test::reversed(some_part(random)));
        }
        case 1: {
            const bool is_edge = random.integer(0, 1) == 0;
            const Mesh box = test::box_mesh({1, 2, 3});
            return joined(box, moved(test::box_mesh({1, 2, is_edge ? 3. : 1.}), {1, 2, is_edge ? 0. : 2.}));
        }
        case 2: {
            Mesh all = some_part(random);
            const int more = random.integer(1, 3);
            for (int i = 1; i <= more; ++i) {
                all = joined(all, moved(some_part(random), {4.5 * i, random.uniform(-1, 1), 0}));
            }
            return all;
        }
        default:
            return some_part(random);
    }
}

/// The triangles of a mesh, turned, scaled and moved at random.
Soup soup_of(const Mesh& mesh, Random& random) {
    const Matrix3 rotation = rotation_of({random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)});
    const double scale = random.uniform(1, 30);
    const Vector3 center{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    Soup soup;
    for (const auto& triangle : mesh.surface->triangles) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = scale * (center + rotation * mesh.surface->vertices_m[triangle[k]]);
        }
        soup.push_back(corners);
    }
    return soup;
}

BoundingBox bounds_of(const Soup& soup) {
    BoundingBox bounds{soup[0][0], soup[0][0]};
    for (const Triangle& triangle : soup) {
        for (const Vector3& corner : triangle) {
            bounds.include({corner, corner});
        }
    }
    return bounds;
}

double extent_of(const Soup& soup) {
    const BoundingBox bounds = bounds_of(soup);
    const Vector3 size = bounds.high_m - bounds.low_m;
    return std::max({size[0], size[1], size[2]});
}

Soup noisy(Soup soup, double noise, Random& random) {
    for (Triangle& triangle : soup) {
        for (Vector3& corner : triangle) {
            for (double& x : corner) {
                x += random.uniform(-noise, noise);
            }
        }
    }
    return soup;
}

std::string printed(const char* before, const Vector3& v, const char* format) {
    std::string text = before;
    for (const double x : v) {
        std::array<char, 64> number{};
        std::snprintf(number.data(), number.size(), format, x);
        text += " " + std::string(number.data());
    }
    return text + "\n";
}

/// A file of triangles that share no corner: binary or ASCII STL, or OBJ.
TriangleMesh read_from_file(const Soup& soup, Random& random) {
    const int kind = random.integer(0, 2);
    if (kind == 0) {
        return parse_mesh(test::binary_stl(soup), "a.stl");
    }
    const char* format = random.integer(0, 1) == 0 ? "%.6f" : "%.8g";
    std::string text = kind == 1 ? "solid a\n" : "o a\n";
    for (const Triangle& triangle : soup) {
        text += kind == 1 ? "facet normal 0 0 0\nouter loop\n" : "";
        for (const Vector3& corner : triangle) {
            text += printed(kind == 1 ? "vertex" : "v", corner, format);
        }
        text += kind == 1 ? "endloop\nendfacet\n" : "f -3 -2 -1\n";
    }
    return parse_mesh(text + (kind == 1 ? "endsolid a\n" : ""), kind == 1 ? "a.stl" : "a.obj");
}

/// Whether a point is in a solid: the solid angle of its surface seen from there (van Oosterom and Strackee 1983).
bool is_inside(const Soup& solid, const Vector3& p) {
    double angle = 0;
    for (const Triangle& triangle : solid) {
        const Vector3 a = triangle[0] - p;
        const Vector3 b = triangle[1] - p;
        const Vector3 c = triangle[2] - p;
        angle += 2 * std::atan2(dot(a, cross(b, c)), length(a) * length(b) * length(c) + dot(a, b) * length(c) +
                                                         dot(b, c) * length(a) + dot(c, a) * length(b));
    }
    return angle > 6.283185307179586;
}

/// Requires that what was read is as solid as the exact solid, at some points away from its surface.
void require_solid(const TriangleMesh& read, const Soup& exact, Random& random) {
    const BoundingBox bounds = bounds_of(exact);
    const double extent = extent_of(exact);
    const Scene scene({{"", Mesh{"", 1, std::make_shared<const TriangleMesh>(read)}, {}, {}}});
    REQUIRE(scene.facts(0).open_edges == 0);
    REQUIRE(scene.facts(0).solid_pieces == scene.facts(0).pieces);
    for (int i = 0; i < 8; ++i) {
        Vector3 p{};
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = random.uniform(bounds.low_m[k], bounds.high_m[k]);
        }
        const bool is_in = is_inside(exact, p);
        bool is_near_surface = false;
        for (std::size_t k = 0; k < 3; ++k) {
            for (const double by : {-0.01, 0.01}) {
                Vector3 other = p;
                other[k] += by * extent;
                is_near_surface = is_near_surface || is_inside(exact, other) != is_in;
            }
        }
        if (!is_near_surface) {
            REQUIRE((disc_clearance_m(scene, p, 1e-3 * extent) == 0) == is_in);
        }
    }
}

/// The middles of the edges at which an odd number of triangles meets. Corners have to be equal to be the same.
std::vector<Vector3> open_edges_of(const Soup& soup) {
    std::map<std::pair<Vector3, Vector3>, int> count;
    for (const Triangle& triangle : soup) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++count[std::minmax(triangle[k], triangle[(k + 1) % 3])];
        }
    }
    std::vector<Vector3> middles;
    for (const auto& [edge, times] : count) {
        if (times % 2 != 0) {
            middles.push_back(0.5 * (edge.first + edge.second));
        }
    }
    return middles;
}

constexpr double max_noise = 1e-6;  // of the extent

}  // namespace

TEST_CASE("Solids of every kind are solid as they are, and rounded by any file") {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        const Soup solid = soup_of(some_solid(random), random);
        REQUIRE(open_edges_of(solid).empty());
        require_solid(*test::soup_of(solid).surface, solid, random);
        const double noise = max_noise * extent_of(solid) * random.uniform(0, 1);
        const TriangleMesh found = read_from_file(noisy(solid, noise, random), random);
        REQUIRE(sides_of(found).facts.pieces == sides_of(*test::soup_of(solid).surface).facts.pieces);
        require_solid(found, solid, random);
    }
}

TEST_CASE("A solid without some of its triangles tells how many edges are open, and where one is") {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        Soup rest = soup_of(some_solid(random), random);
        const int missing = random.integer(1, 3);
        for (int i = 0; i < missing; ++i) {
            rest.erase(rest.begin() + random.integer(0, static_cast<int>(rest.size()) - 1));
        }
        const double extent = extent_of(rest);
        const std::vector<Vector3> middles = open_edges_of(rest);
        REQUIRE_FALSE(middles.empty());
        const TriangleMesh found = read_from_file(noisy(rest, max_noise * extent, random), random);
        const SurfaceFacts facts = sides_of(found).facts;
        REQUIRE(facts.open_edges == middles.size());
        REQUIRE(facts.solid_pieces < facts.pieces);
        REQUIRE(std::any_of(middles.begin(), middles.end(),
                            [&](const Vector3& middle) { return length(middle - facts.open_place) < 1e-5 * extent; }));
    }
}

TEST_CASE("Triangles that are turned the wrong way do not change what is solid") {
    Random random(3);
    for (int round = 0; round < 100; ++round) {
        CAPTURE(round);
        const Soup solid = soup_of(some_part(random), random);
        Soup turned = solid;
        const auto count = static_cast<int>(turned.size());
        // One, some, all but some, or all.
        const int turns = round % 4 == 0 ? 1 : round % 4 == 1 ? count : random.integer(1, count);
        for (int i = 0; i < turns; ++i) {
            std::swap(turned[static_cast<std::size_t>(i)][1], turned[static_cast<std::size_t>(i)][2]);
        }
        require_solid(read_from_file(noisy(turned, max_noise * extent_of(solid), random), random), solid, random);
    }
    // Of a wall around a cavity less than half of each surface.
    for (int round = 0; round < 50; ++round) {
        CAPTURE(round);
        const Mesh part = some_part(random);
        const Soup solid = soup_of(joined(test::box_mesh({5, 5, 5}), test::reversed(part)), random);
        Soup turned = solid;
        const int of_part = static_cast<int>(turned.size()) - 12;
        for (const auto& [first, most] : {std::pair(0, 5), std::pair(12, (of_part - 1) / 2)}) {
            for (int i = random.integer(0, most); i > 0; --i) {
                Triangle& triangle = turned[static_cast<std::size_t>(first + i)];
                std::swap(triangle[1], triangle[2]);
            }
        }
        require_solid(read_from_file(noisy(turned, max_noise * extent_of(solid), random), random), solid, random);
    }
}

TEST_CASE("Triangles that are there twice, turned or not, do not change what is solid") {
    Random random(4);
    for (int round = 0; round < 150; ++round) {
        CAPTURE(round);
        const Soup solid = soup_of(some_solid(random), random);
        Soup doubled = solid;
        for (const Triangle& triangle : solid) {
            const bool is_turned = round % 3 == 1 || (round % 3 == 2 && random.integer(0, 1) == 0);
            if (round % 6 >= 3 || random.integer(0, 2) == 0) {  // every one, or some
                doubled.push_back(is_turned ? Triangle{triangle[0], triangle[2], triangle[1]} : triangle);
            }
        }
        require_solid(read_from_file(noisy(doubled, max_noise * extent_of(solid), random), random), solid, random);
    }
}
