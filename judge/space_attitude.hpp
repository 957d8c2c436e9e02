#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "downwash/base/export.hpp"

// Errors of the attitude, tilt and yaw apart (docs/model.md 5.9), as rotation matrices. Private: not installed.

namespace downwash::judge {

/// Where a force points, tilted no further than a limit and with a least vertical part.
struct WantedDirection {
    Eigen::Vector3d direction;  ///< world, of length 1
    bool is_limited;
};
[[nodiscard]] DOWNWASH_EXPORT WantedDirection direction_of(const Eigen::Vector3d& force, double max_tilt_rad,
                                                           double least_vertical);

/// The turn that takes a unit vector to another by the shortest way: its axis times its angle [rad].
/// @param if_opposite its axis, of length 1, where both are opposite
[[nodiscard]] DOWNWASH_EXPORT Eigen::Vector3d shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                                            const Eigen::Vector3d& if_opposite);

/// The rotation by an axis times an angle [rad].
[[nodiscard]] DOWNWASH_EXPORT Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn_rad);

/// What of the attitude error is left once the thrust points where it shall.
struct YawLeft {
    double angle_rad;  ///< about the wanted thrust direction, from the vehicle to the wanted heading
    double weight;     ///< (1 + cos tilt error) / 2
};
/// @param axis of the thrust, body axes   @param wanted where it shall point, world
[[nodiscard]] DOWNWASH_EXPORT YawLeft yaw_left(const Eigen::Matrix3d& attitude, const Eigen::Vector3d& axis,
                                               const Eigen::Vector3d& wanted, double yaw_rad);

/// How fast the wanted attitude turns about its thrust direction [rad/s].
/// @param direction_rate of the wanted direction, world [rad/s]
[[nodiscard]] DOWNWASH_EXPORT double wanted_yaw_rate(const Eigen::Vector3d& wanted,
                                                     const Eigen::Vector3d& direction_rate, double yaw_rad,
                                                     double yaw_rate_rad_s);

}  // namespace downwash::judge
