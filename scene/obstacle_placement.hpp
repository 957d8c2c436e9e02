#pragma once

#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// From a frame turned by roll, pitch and yaw to the one around it: Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] inline Matrix3 rotation_of(const Vector3& rpy_rad) {
    double sr, cr, sp, cp, sy, cy;
    lane::sin_cos(rpy_rad[0], sr, cr);
    lane::sin_cos(rpy_rad[1], sp, cp);
    lane::sin_cos(rpy_rad[2], sy, cy);
    return {{{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
             {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
             {-sp, cp * sr, cp * cr}}};
}

/// How an obstacle's own frame lies in the world.
class ObstaclePlacement {
 public:
    /// Keeps nothing of the obstacle.
    explicit ObstaclePlacement(const Obstacle& obstacle)
        : center_m_(obstacle.center_world_m), rotation_(rotation_of(obstacle.rpy_rad)) {}

    /// A point of the own frame in the world [m].
    [[nodiscard]] Vector3 to_world(const Vector3& own_m) const { return center_m_ + rotation_ * own_m; }

 private:
    Vector3 center_m_;
    Matrix3 rotation_;
};

/// A body of a robot as an obstacle of the robot's own frame.
[[nodiscard]] inline Obstacle as_obstacle(const BodyShape& body) {
    return {"", std::visit([](const auto& shape) { return Shape(shape); }, body.shape), body.center_body_m, {}};
}

}  // namespace downwash
