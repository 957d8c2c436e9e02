// Faces of every shape as files have them: with holes, rounded to the digits of text, in map coordinates, and large.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "../support/polygons.hpp"
#include "../support/random.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/polygon_triangles.hpp"
#include "downwash/scene/scene.hpp"

using namespace downwash;
using test::is_inside;
using test::length;
using test::Polygon;
using test::Random;
using test::twice_area;

namespace {

/// A face in the plane z = 0 with holes, each of which a bridge joins to the outer edge.
struct FaceWithHoles {
    Polygon outer, outline;  ///< without the holes, and as a file has it
    std::vector<Polygon> holes;

    [[nodiscard]] bool has(const Vector3& p) const {
        return is_inside(outer, p) &&
               std::none_of(holes.begin(), holes.end(), [&](const Polygon& hole) { return is_inside(hole, p); });
    }
};

/// A strip with jagged edges and up to five holes, the first corner of each straight above one of the lower edge.
FaceWithHoles some_face_with_holes(Random& random) {
    FaceWithHoles face;
    const auto add = [&face](const Vector3& p) {
        face.outer.push_back(p);
        face.outline.push_back(p);
    };
    const int count = random.integer(1, 5);
    add({-1.5, -1.25, 0});
    for (int i = 0; i < count; ++i) {
        add({3. * i - random.uniform(0.8, 1.4), -random.uniform(1, 2), 0});
        add({3. * i, -random.uniform(1, 2), 0});
        Polygon hole;
        const int corners = random.integer(3, 8);
        for (int k = 0; k < corners; ++k) {
            const double around = k == 0 ? 0 : k + random.uniform(-0.2, 0.2);
            const double angle = -1.5707963267948966 - 6.283185307179586 * around / corners;
            const double radius = random.uniform(0.3, 0.9);
            hole.push_back({k == 0 ? 3. * i : 3 * i + radius * std::cos(angle), radius * std::sin(angle), 0});
        }
        face.outline.insert(face.outline.end(), hole.begin(), hole.end());
        face.outline.push_back(hole[0]);
        face.outline.push_back(face.outer.back());
        face.holes.push_back(std::move(hole));
    }
    add({3. * count - 1.5, -1.25, 0});
    for (double x = 3. * count - 1.5; x > -1.5; x -= random.uniform(0.3, 2)) {
        add({x, random.uniform(1, 2), 0});
    }
    add({-1.5, 1.5, 0});
    return face;
}

double area(const Polygon& polygon) {
    return length(twice_area(polygon)) / 2;
}

/// How many of the triangles of a face in the plane z = 0 have a point of it inside.
int count_over(const Polygon& flat, const FaceCut& cut, const Vector3& p) {
    return static_cast<int>(std::count_if(cut.triangles.begin(), cut.triangles.end(), [&](const auto& t) {
        return is_inside({flat[t[0]], flat[t[1]], flat[t[2]]}, p);
    }));
}

double area_of(const Polygon& polygon, const FaceCut& cut) {
    double sum = 0;
    for (const auto& [a, b, c] : cut.triangles) {
        sum += length(cross(polygon[b] - polygon[a], polygon[c] - polygon[a])) / 2;
    }
    return sum;
}

double volume_of(const TriangleMesh& mesh, const Vector3& around) {
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto& v = mesh.vertices_m;
        volume += dot(v[a] - around, cross(v[b] - around, v[c] - around)) / 6;
    }
    return volume;
}

std::string printed(const Vector3& v, int decimals) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "v %.*f %.*f %.*f\n", decimals, v[0], decimals, v[1], decimals, v[2]);
    return text.data();
}

/// A prism of as many faces as its base has edges and two more, its base turned up.
std::string prism_obj(const Polygon& low, const Polygon& high, int decimals) {
    std::string text;
    std::string bottom = "f";
    std::string top = "f";
    for (const Polygon* ring : {&low, &high}) {
        for (const Vector3& v : *ring) {
            text += printed(v, decimals);
        }
    }
    const std::size_t count = low.size();
    for (std::size_t i = 0; i < count; ++i) {
        bottom += " " + std::to_string(count - i);
        top += " " + std::to_string(count + 1 + i);
    }
    text += bottom + "\n" + top + "\n";
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % count;
        text += "f " + std::to_string(i + 1) + " " + std::to_string(next + 1) + " " + std::to_string(next + count + 1) +
                " " + std::to_string(i + count + 1) + "\n";
    }
    return text;
}

/// Distance of a point of the plane z = 0 from the edges of a polygon there.
double distance_to_edges(const Polygon& flat, const Vector3& p) {
    double least = 1e9;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Vector3 edge = flat[(i + 1) % flat.size()] - flat[i];
        const double along = std::clamp(dot(p - flat[i], edge) / dot(edge, edge), 0., 1.);
        least = std::min(least, length(p - flat[i] - along * edge));
    }
    return least;
}

}  // namespace

TEST_CASE("Holes that bridges join stay open, in any plane, whichever corner comes first") {
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        CAPTURE(round);
        const FaceWithHoles face = some_face_with_holes(random);
        double expected = area(face.outer);
        for (const Polygon& hole : face.holes) {
            expected -= area(hole);
        }
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)};
        const Vector3 center{random.magnitude(-2, 2), random.magnitude(-2, 2), random.magnitude(-2, 2)};
        const double scale = std::abs(random.magnitude(-2, 2));
        for (int order = 0; order < 4; ++order) {
            Polygon flat = test::started_at(
                face.outline, static_cast<std::size_t>(random.integer(0, static_cast<int>(face.outline.size()) - 1)));
            if (order % 2 == 1) {
                std::reverse(flat.begin(), flat.end());
            }
            const Polygon polygon = test::placed(flat, rpy, center, scale);
            const FaceCut cut = cut_face(polygon);
            REQUIRE(cut.fault == FaceFault::none);
            REQUIRE(cut.triangles.size() == polygon.size() - 2);
            REQUIRE(area_of(polygon, cut) == Approx(expected * scale * scale).epsilon(1e-9).margin(0));
            for (int i = 0; i < 40; ++i) {
                const Vector3 p{random.uniform(-2, 15), random.uniform(-2, 2), 0};
                REQUIRE(count_over(flat, cut, p) == (face.has(p) ? 1 : 0));
            }
        }
    }
}

TEST_CASE("A solid of faces of any shape is solid and as large as it is, however its file rounds it") {
    Random random(2);
    int solids = 0;
    while (solids < 200) {
        Polygon flat = test::some_polygon(random, random.integer(4, 30));
        if (twice_area(flat)[2] < 0) {
            std::reverse(flat.begin(), flat.end());
        }
        if (area(flat) < 0.05) {
            continue;
        }
        CAPTURE(solids);
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)};
        const bool is_on_map = solids % 3 == 0;
        const Vector3 offset = is_on_map ? Vector3{691000, 5334000, 500} : Vector3{};
        const double scale = random.uniform(is_on_map ? 20 : 1, 50);
        const double height = random.uniform(0.2, 2);
        Polygon lifted = flat;
        for (Vector3& p : lifted) {
            p[2] = height;
        }
        const Vector3 center = offset + Vector3{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
        const std::string text = prism_obj(test::placed(flat, rpy, center, scale),
                                           test::placed(lifted, rpy, center, scale), is_on_map ? 5 : 6);
        const auto mesh = std::make_shared<const TriangleMesh>(parse_mesh(text, "a.obj"));
        REQUIRE(mesh->remarks.empty());
        const double expected = area(flat) * height * scale * scale * scale;
        REQUIRE(volume_of(*mesh, center) == Approx(expected).epsilon(1e-4));
        const Scene scene({{"", Mesh{"", 1, mesh, offset}, {}, {}}});
        REQUIRE(scene.facts(0).pieces == 1);
        REQUIRE(scene.facts(0).solid_pieces == 1);
        REQUIRE(scene.facts(0).open_edges == 0);
        for (int i = 0; i < 20; ++i) {
            const Vector3 at{random.uniform(-1, 1), random.uniform(-1, 1), 0};
            if (distance_to_edges(flat, at) < 1e-3) {
                continue;
            }
            const double up = random.uniform(0.01, 0.99) * height;
            const Vector3 p = test::placed({{at[0], at[1], up}}, rpy, center - offset, scale)[0];
            REQUIRE((disc_clearance_m(scene, p, 1e-4 * scale) == 0) == is_inside(flat, at));
        }
        ++solids;
    }
}

TEST_CASE("Ten thousand corners are cut soon, whatever they wind around") {
    constexpr int corners = 10'000;
    Random random(3);
    Polygon star;
    for (int i = 0; i < corners; ++i) {
        const double radius = random.uniform(0.5, 1);
        const double angle = 6.283185307179586 * i / corners;
        star.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    Polygon comb;  // its teeth lie one above the other
    for (int i = 0; i < corners - 2; ++i) {
        comb.push_back({i % 2 == 0 ? 0.1 : 1., 0.001 * i, 0});
    }
    comb.push_back({0, 0.001 * (corners - 2), 0});
    comb.push_back({0, 0, 0});
    Polygon spiral;  // inwards, and back beside itself
    for (int i = 0; i < corners / 2; ++i) {
        const double angle = 0.01 * i;
        spiral.push_back({(100 - angle) * std::cos(angle), (100 - angle) * std::sin(angle), 0});
    }
    for (int i = corners / 2 - 1; i >= 0; --i) {
        const double angle = 0.01 * i;
        spiral.push_back({(97 - angle) * std::cos(angle), (97 - angle) * std::sin(angle), 0});
    }
    for (const Polygon* polygon : {&star, &comb, &spiral}) {
        const FaceCut cut = cut_face(*polygon);
        REQUIRE(cut.fault == FaceFault::none);
        CHECK(area_of(*polygon, cut) == Approx(area(*polygon)).epsilon(1e-9));
        CHECK(cut.comparisons < max_face_comparisons / 2);
        // Less work than that is an error, not a part of the face.
        const FaceCut part = cut_face(*polygon, cut.comparisons / 2);
        CHECK(part.fault == FaceFault::too_large);
        CHECK(part.triangles.empty());
    }
}
