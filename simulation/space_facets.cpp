#include "downwash/simulation/space_facets.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/solid_surface.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash::simulation {

std::vector<Facet> facets_of(const SpaceContactGoal& goal, const std::vector<Obstacle>& obstacles) {
    std::vector<Facet> facets;
    double area_m2 = 0;
    for (const Obstacle& obstacle : obstacles) {
        const TriangleMesh surface = surface_of(obstacle);
        for (const auto& corners : surface.triangles) {
            const Vector3& a = surface.vertices_m[corners[0]];
            const Vector3 first = surface.vertices_m[corners[1]] - a, second = surface.vertices_m[corners[2]] - a;
            const Vector3 normal = cross(first, second);
            const double twice_m2 = length_of(normal);
            if (!(twice_m2 > 0)) {
                continue;
            }
            const bool has_two_sides = std::holds_alternative<Mesh>(obstacle.shape);
            const Vector3 n = (1 / twice_m2) * normal;
            // The multirotor touches from below.
            const double down = has_two_sides ? std::abs(n[2]) : -n[2];
            if (goal.part == TouchingPart::frame && down < lane::sin_cos(touch_angle_rad).cosine) {
                continue;
            }
            if (goal.position_m && std::abs(dot(*goal.position_m - a, n)) > goal.tolerance_m) {
                continue;
            }
            area_m2 += 0.5 * twice_m2;
            facets.push_back({a, first, second, n, area_m2, has_two_sides});
        }
    }
    return facets;
}

Vector3 Facet::nearest_m(const Vector3& to_m) const {
    const Vector3 off_m = to_m - corner_m;
    const double a = dot(first_m, first_m), b = dot(first_m, second_m), c = dot(second_m, second_m);
    const double d = dot(first_m, off_m), e = dot(second_m, off_m);
    const double determinant = a * c - b * b;
    double s = std::max(0.0, (c * d - b * e) / determinant);
    double t = std::max(0.0, (a * e - b * d) / determinant);
    if (s + t > 1) {
        const double sum = s + t;
        s /= sum;
        t /= sum;
    }
    return corner_m + s * first_m + t * second_m;
}

}  // namespace downwash::simulation
