#pragma once

#include <Eigen/Geometry>

#include "downwash/scene/shapes.hpp"

// Where obstacles stand. Private: not installed.

namespace downwash::judge {

inline Eigen::Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// The frame of an obstacle in the world, R = Rz(yaw) Ry(pitch) Rx(roll).
inline Eigen::Isometry3d pose_of(const Obstacle& obstacle) {
    using Turn = Eigen::AngleAxisd;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = vector_of(obstacle.center_world_m);
    pose.linear() =
        (Turn(obstacle.rpy_rad[2], Eigen::Vector3d::UnitZ()) * Turn(obstacle.rpy_rad[1], Eigen::Vector3d::UnitY()) *
         Turn(obstacle.rpy_rad[0], Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    return pose;
}

/// The rotation by the shortest way that turns the z axis into a direction, of any length but zero. Not inline: it
/// takes the compiler six seconds, and many sources call it.
[[nodiscard]] Eigen::Quaterniond turn_from_z(const Eigen::Vector3d& direction);

}  // namespace downwash::judge
