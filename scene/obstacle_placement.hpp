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

/// A body of a robot as an obstacle of the robot's own frame.
[[nodiscard]] inline Obstacle as_obstacle(const BodyShape& body) {
    return {"", std::visit([](const auto& shape) { return Shape(shape); }, body.shape), body.center_body_m, {}};
}

}  // namespace downwash
