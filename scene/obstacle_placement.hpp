#pragma once

#include <array>
#include <cstddef>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// How an obstacle's own frame lies in the world: turned by Rz(yaw) Ry(pitch) Rx(roll), then moved to the centre.
class ObstaclePlacement {
 public:
    /// Keeps nothing of the obstacle.
    explicit ObstaclePlacement(const Obstacle& obstacle) : center_m_(obstacle.center_m) {
        for (std::size_t i = 0; i < 3; ++i) {
            lane::sin_cos(obstacle.rpy_rad[i], sine_[i], cosine_[i]);
        }
    }

    /// A point of the own frame in the world [m].
    [[nodiscard]] Vector3 to_world(const Vector3& own_m) const {
        Vector3 p{own_m[0], cosine_[0] * own_m[1] - sine_[0] * own_m[2], sine_[0] * own_m[1] + cosine_[0] * own_m[2]};
        p = {cosine_[1] * p[0] + sine_[1] * p[2], p[1], -sine_[1] * p[0] + cosine_[1] * p[2]};
        p = {cosine_[2] * p[0] - sine_[2] * p[1], sine_[2] * p[0] + cosine_[2] * p[1], p[2]};
        return {p[0] + center_m_[0], p[1] + center_m_[1], p[2] + center_m_[2]};
    }

 private:
    Vector3 center_m_;
    std::array<double, 3> sine_{}, cosine_{};
};

/// A body of a robot as an obstacle of the robot's own frame.
[[nodiscard]] inline Obstacle as_obstacle(const BodyShape& body) {
    return {"", std::visit([](const auto& shape) { return Shape(shape); }, body.shape), body.center_m, {}};
}

}  // namespace downwash
