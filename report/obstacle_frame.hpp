#pragma once

// Private: not installed.

#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The transformation from an obstacle's own frame to coordinates of a vertical plane: along it, to its left, and up.
class ObstacleFrame {
 public:
    /// @param lateral_m of the plane that is drawn, to the left of the plane of motion
    ObstacleFrame(const Obstacle& obstacle, const PlaneOfMotion& plane, double lateral_m)
        : placement_(obstacle), plane_(plane), lateral_m_(lateral_m) {}

    /// A point given in the own frame, as (x, lateral, z) [m].
    [[nodiscard]] Vector3 operator()(const Vector3& own_m) const {
        const Vector3 p = plane_.from_world(placement_.to_world(own_m));
        return {p[0], p[1] - lateral_m_, p[2]};
    }

 private:
    ObstaclePlacement placement_;
    const PlaneOfMotion& plane_;
    double lateral_m_;
};

}  // namespace downwash
