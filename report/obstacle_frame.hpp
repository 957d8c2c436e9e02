#pragma once

// Private: not installed.

#include <array>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// How an obstacle's own frame lies in the coordinates of a vertical plane: R = Rz(yaw) Ry(pitch) Rx(roll), then along
/// the plane, to the left of it, and up.
class ObstacleFrame {
 public:
    /// @param lateral_m of the plane that is drawn, to the left of the plane of motion
    ObstacleFrame(const Obstacle& obstacle, const PlaneOfMotion& plane, double lateral_m)
        : obstacle_(obstacle), plane_(plane), lateral_m_(lateral_m) {
        for (std::size_t i = 0; i < 3; ++i) {
            lane::sin_cos(obstacle.rpy_rad[i], sine_[i], cosine_[i]);
        }
    }

    /// A point of the own frame: (x, lateral, z) [m].
    [[nodiscard]] Vector3 operator()(const Vector3& own_m) const {
        Vector3 p = own_m;
        p = {p[0], cosine_[0] * p[1] - sine_[0] * p[2], sine_[0] * p[1] + cosine_[0] * p[2]};
        p = {cosine_[1] * p[0] + sine_[1] * p[2], p[1], -sine_[1] * p[0] + cosine_[1] * p[2]};
        p = {cosine_[2] * p[0] - sine_[2] * p[1], sine_[2] * p[0] + cosine_[2] * p[1], p[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] += obstacle_.center_m[i];
        }
        p = plane_.from_world(p);
        return {p[0], p[1] - lateral_m_, p[2]};
    }

 private:
    const Obstacle& obstacle_;
    const PlaneOfMotion& plane_;
    double lateral_m_;
    std::array<double, 3> sine_{}, cosine_{};
};

}  // namespace downwash
