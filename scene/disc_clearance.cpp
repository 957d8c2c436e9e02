#include <algorithm>
#include <limits>

#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/solids.hpp"

namespace downwash {
namespace {

Convex level_disc(const Vector3& center_m, double radius_m) {
    return {.center_m = center_m, .disc_radius_m = radius_m};
}

}  // namespace

double disc_clearance_m(const Scene& scene, const Vector3& center_m, double radius_m) {
    const Scene::Solids& solids = scene.solids();
    const Convex disc = level_disc(center_m, radius_m);
    const Scene::Bounds bounds = bounds_of(disc);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < solids.convexes.size(); ++i) {
        if (gap_m(bounds, solids.bounds[i]) < least) {
            least = std::min(least, distance_m(disc, solids.convexes[i], least));
        }
    }
    return std::max(0.0, least);
}

bool disc_is_clear(const Scene& scene, const Vector3& center_m, double radius_m, double distance_m) {
    const Scene::Solids& solids = scene.solids();
    const Convex disc = level_disc(center_m, radius_m);
    const Scene::Bounds bounds = bounds_of(disc);
    for (std::size_t i = 0; i < solids.convexes.size(); ++i) {
        if (gap_m(bounds, solids.bounds[i]) <= distance_m && is_nearer_than(disc, solids.convexes[i], distance_m)) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash
