#include <algorithm>

#include "downwash/base/infinity.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

/// A disc touches what is nearer than this.
constexpr double touching_m = 1e-6;

Convex level_disc(const Vector3& center_m, double radius_m) {
    return {.center_m = center_m, .disc_radius_m = radius_m};
}

/// How far a point lies from a box within the horizontal plane through it; infinite when the plane passes the box by.
double level_gap_m(const BoundingBox& box, const Vector3& p_m) {
    if (p_m[2] < box.low_m[2] || p_m[2] > box.high_m[2]) {
        return infinity;
    }
    return std::max(
        {0.0, box.low_m[0] - p_m[0], p_m[0] - box.high_m[0], box.low_m[1] - p_m[1], p_m[1] - box.high_m[1]});
}

/// The radius at which a level disc around the point first touches a solid that the disc's plane cuts; any lower bound
/// of it that is at least `enough_m`. The distance of a growing disc is a convex function of its radius, so that the
/// line through two of its values meets zero before the function does.
double touching_radius_m(const Convex& solid, const Vector3& p_m, double enough_m) {
    constexpr double tolerance_m = 1e-9;
    constexpr int max_steps = 60;  // a handful but where the plane grazes a round solid
    double radius = 0;
    double distance = distance_m(level_disc(p_m, 0), solid, enough_m);
    double next = distance;
    for (int step = 0; step < max_steps && distance > tolerance_m && next < enough_m; ++step) {
        const double before = distance;
        const double grown = next - radius;
        radius = next;
        distance = distance_m(level_disc(p_m, radius), solid, enough_m - radius);
        const double fall = before - distance;
        next = radius + (fall > 0 ? std::max(distance, distance * grown / fall) : distance);
    }
    return std::max(radius, distance <= tolerance_m ? radius : next);
}

}  // namespace

double disc_clearance_m(const Scene& scene, const Vector3& center_m, double radius_m) {
    return std::max(0.0, scene.solids().clearance_m(level_disc(center_m, radius_m), infinity));
}

bool disc_is_clear(const Scene& scene, const Vector3& center_m, double radius_m, double distance_m) {
    return !scene.solids().are_near(level_disc(center_m, radius_m), std::max(distance_m, touching_m));
}

bool column_is_clear(const Scene& scene, const Vector3& center_m, double radius_m, double height_m) {
    const double half_m = 0.5 * height_m;
    Convex column = level_disc({center_m[0], center_m[1], center_m[2] + half_m}, radius_m);
    column.segment_count = 1;
    column.half_axes_m[0] = {0, 0, half_m};
    return !scene.solids().are_near(column, touching_m);
}

double horizontal_clearance_m(const Scene& scene, const Vector3& point_m) {
    const SceneSolids& solids = scene.solids();
    double min_m = infinity;
    const auto gap = [&](const BoundingBox& box) { return level_gap_m(box, point_m); };
    solids.parts.any(gap, min_m, [&](std::size_t part) {
        if (gap(solids.parts.bounds(part)) < min_m) {
            min_m = std::min(min_m, solids.parts.with_convex(part, [&](const Convex& convex) {
                return touching_radius_m(convex, point_m, min_m);
            }));
        }
        return min_m <= 0;
    });
    return solids.is_inside_mesh(point_m) ? 0 : std::max(0.0, min_m);
}

}  // namespace downwash
