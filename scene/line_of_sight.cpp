#include "downwash/scene/line_of_sight.hpp"

#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {

bool is_line_clear(const Scene& scene, const Vector3& from_m, const Vector3& to_m, double radius_m) {
    const Convex line{.center_m = 0.5 * (from_m + to_m),
                      .segment_count = 1,
                      .half_axes_m = {0.5 * (to_m - from_m), Vector3{}, Vector3{}}};
    return !scene.solids().are_near(line, radius_m);
}

}  // namespace downwash
