#include "downwash/scene/scene_solids.hpp"

#include <algorithm>
#include <iterator>

namespace downwash {

bool SceneSolids::are_near(const Convex& solid, double distance_m) const {
    const double near_m = std::max(distance_m, contact_m);
    const BoundingBox around = bounds_of(solid);
    const auto gap = [&](const BoundingBox& box) { return gap_m(around, box); };
    const auto is_near = [&](std::size_t part) {
        return gap(parts.bounds(part)) <= near_m &&
               parts.with_convex(part, [&](const Convex& convex) { return is_nearer_than(solid, convex, near_m); });
    };
    return parts.any(gap, near_m, is_near) || is_inside_mesh(solid.center_m);
}

double SceneSolids::clearance_m(const Convex& solid, double enough_m) const {
    double min_m = enough_m;
    const BoundingBox around = bounds_of(solid);
    const auto gap = [&](const BoundingBox& box) { return box_distance_m(around, box); };
    parts.any(gap, min_m, [&](std::size_t part) {
        if (gap(parts.bounds(part)) < min_m) {
            min_m = std::min(
                min_m, parts.with_convex(part, [&](const Convex& convex) { return distance_m(solid, convex, min_m); }));
        }
        return min_m <= 0;
    });
    return min_m > 0 && is_inside_mesh(solid.center_m) ? 0 : min_m;
}

std::optional<NearObstacle> SceneSolids::nearest(const Convex& solid, double within_m) const {
    std::optional<NearObstacle> found;
    double min_m = within_m;
    const BoundingBox around = bounds_of(solid);
    const auto gap = [&](const BoundingBox& box) { return box_distance_m(around, box); };
    parts.any(gap, min_m, [&](std::size_t part) {
        if (gap(parts.bounds(part)) < min_m) {
            const double part_m =
                parts.with_convex(part, [&](const Convex& convex) { return distance_m(solid, convex, min_m); });
            if (part_m < min_m) {
                min_m = part_m;
                found = NearObstacle{obstacle_of(part), part_m};
            }
        }
        return min_m <= 0;
    });
    if (!closed_surfaces.empty() && min_m > 0) {
        if (const ClosedSurface* surface = surface_around(solid.center_m)) {
            return NearObstacle{surface->obstacle, 0};
        }
    }
    return found;
}

std::size_t SceneSolids::obstacle_of(std::size_t part) const noexcept {
    if (part < parts.first_octree_box()) {
        return obstacle_of_primitive[part];
    }
    if (part < parts.first_triangle()) {
        return obstacle_of_octree[parts.octree_boxes[part - parts.first_octree_box()].turned];
    }
    const auto after =
        std::upper_bound(meshes.begin(), meshes.end(), part - parts.first_triangle(),
                         [](std::size_t triangle, const FirstTriangle& mesh) { return triangle < mesh.first; });
    return std::prev(after)->obstacle;
}

const SceneSolids::ClosedSurface* SceneSolids::surface_around(const Vector3& p_m) const noexcept {
    const auto apart_upwards = [&](const BoundingBox& box) {
        return std::max({box.low_m[0] - p_m[0], p_m[0] - box.high_m[0], box.low_m[1] - p_m[1], p_m[1] - box.high_m[1],
                         p_m[2] - box.high_m[2]});
    };
    const auto found = std::find_if(closed_surfaces.begin(), closed_surfaces.end(), [&](const ClosedSurface& surface) {
        if (apart_upwards(surface.bounds) > 0 || p_m[2] < surface.bounds.low_m[2]) {
            return false;
        }
        int turns = 0;
        parts.any_other(apart_upwards, 0, [&](std::size_t part) {
            const std::size_t triangle = part - parts.first_triangle();  // huge for other parts
            if (triangle >= surface.first && triangle < surface.last) {
                turns += winding_above(parts.triangles[triangle], p_m);
            }
            return false;
        });
        return turns != 0;
    });
    return found != closed_surfaces.end() ? &*found : nullptr;
}

}  // namespace downwash
