#pragma once

// Private: not installed.

#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The transformation from an obstacle's own frame to coordinates of a vertical plane: along it, to its left, and up.
struct ObstacleFrame {
    /// @param lateral of the plane that is drawn, to the left of the plane of motion [m]
    ObstacleFrame(const Obstacle& obstacle, const PlaneOfMotion& motion, double lateral)
        : center_m(obstacle.center_world_m),
          rotation(rotation_of(obstacle.rpy_rad)),
          plane(motion),
          lateral_m(lateral) {}

    /// A point given in the own frame, as (x, lateral, z) [m].
    [[nodiscard]] Vector3 operator()(const Vector3& own_m) const {
        return plane.from_world(center_m + rotation * own_m) - Vector3{0, lateral_m, 0};
    }

    Vector3 center_m;
    Matrix3 rotation;
    const PlaneOfMotion& plane;
    double lateral_m;
};

}  // namespace downwash
