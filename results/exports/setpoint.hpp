#pragma once

#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The commanded motion of a joint, relative to what its link is mounted on.
struct JointSetpoint {
    double angle_rad = 0;
    double rate_rad_s = 0;
    double acceleration_rad_s2 = 0;
};

/// The commanded motion of vehicle and arm at one time, in the world frame (x forward, y left, z up).
struct Setpoint {
    double t_s = 0;
    Vector3 position_m{};
    Vector3 velocity_m_s{};
    Vector3 acceleration_m_s2{};
    double yaw_rad = 0;  ///< about z, not wrapped; in a plane of motion that of the plane
    double yaw_rate_rad_s = 0;
    double yaw_acceleration_rad_s2 = 0;
    std::vector<JointSetpoint> joints;  ///< from the multirotor outward
    Vector3 jerk_m_s3{};                ///< of `position_m`; known where the plan is, not at one point of it
};

/// A point of a reference in the world, without its jerk.
[[nodiscard]] Setpoint setpoint_of(double t_s, const ReferencePoint& point, const PlaneOfMotion& plane);
/// The same in space. @param joints of the robot
[[nodiscard]] Setpoint setpoint_of(double t_s, const SpacePoint& point, int joints);

}  // namespace downwash
