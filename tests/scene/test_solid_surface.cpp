#include "downwash/scene/solid_surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <utility>

using namespace downwash;

namespace {

/// By the divergence theorem; positive when the triangles face outwards.
double volume_of(const TriangleMesh& surface) {
    double volume = 0;
    for (const auto& [i, j, k] : surface.triangles) {
        const Vector3 &a = surface.vertices_m[i], &b = surface.vertices_m[j], &c = surface.vertices_m[k];
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6;
    }
    return volume;
}

bool is_closed(const TriangleMesh& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& triangle : surface.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++edges[{triangle[i], triangle[(i + 1) % 3]}];
        }
    }
    for (const auto& [edge, count] : edges) {
        if (count != 1 || !edges.contains({edge.second, edge.first})) {
            return false;
        }
    }
    return true;
}

constexpr double pi = 3.14159265358979323846;
const Vector3 somewhere{1, -2, 3}, turned{0.3, -0.4, 2};

}  // namespace

TEST_CASE("surfaces of solids are closed, face outwards and hold the solid's volume") {
    const TriangleMesh box = surface_of({"", Box{{1, 2, 3}}, somewhere, turned});
    CHECK(is_closed(box));
    CHECK(volume_of(box) == Approx(6));
    const Vector3 axis = GENERATE(Vector3{0, 0, 1}, Vector3{1, 2, -3}, Vector3{0, 0, -2}, Vector3{0, 5, 0});
    const TriangleMesh cylinder = surface_of({"", Cylinder{0.5, 4, axis}, somewhere, turned});
    CHECK(is_closed(cylinder));
    CHECK(volume_of(cylinder) == Approx(48 / 2. * std::sin(2 * pi / 48) * 0.25 * 4));
    const TriangleMesh sphere = surface_of({"", Sphere{0.5}, somewhere, turned});
    CHECK(is_closed(sphere));
    CHECK(volume_of(sphere) == Approx(4 * pi / 3 / 8).epsilon(0.01));
    CHECK(volume_of(sphere) < 4 * pi / 3 / 8);
    const TriangleMesh rod = rod_surface(1.2, 0.03);
    CHECK(is_closed(rod));
    CHECK(volume_of(rod) == Approx(12 * std::sin(2 * pi / 24) * 0.0009 * 1.2));
}

TEST_CASE("a cylinder's surface lies along its axis") {
    const TriangleMesh surface = surface_of({"", Cylinder{0.5, 4, {3, 0, 4}}, {10, 0, 0}, {}});
    for (const Vector3& vertex_m : surface.vertices_m) {
        const double along_m = 0.6 * (vertex_m[0] - 10) + 0.8 * vertex_m[2];
        CHECK(std::abs(along_m) == Approx(2));
    }
}
