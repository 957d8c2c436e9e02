#pragma once

#include <functional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/plan.hpp"
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
};

/// A point of a reference in the world.
[[nodiscard]] Setpoint setpoint_of(double t_s, const ReferencePoint& point, const PlaneOfMotion& plane);
/// The same in space. @param joints of the robot
[[nodiscard]] Setpoint setpoint_of(double t_s, const SpacePoint& point, int joints);

/// What there is at every 1 / rate_hz from 0 on, and at the end. @param rate_hz in (0, 10000]
/// @throws InputError if there would be more than a million set-points, or the rate is out of range
[[nodiscard]] std::vector<Setpoint> setpoints(const std::function<Setpoint(double t_s)>& at, double end_s,
                                              double rate_hz);

/// The reference of a plan at every 1 / rate_hz from 0 on, and at its end. After the last knot it stays constant.
/// @param end_s of the flight, hover at the goal included; at least the plan's duration is used   @param rate_hz in (0,
/// 10000]
/// @throws InputError if there would be more than a million set-points, or the rate is out of range
[[nodiscard]] DOWNWASH_EXPORT std::vector<Setpoint> setpoints(const Plan& plan, const PlaneOfMotion& plane,
                                                              double end_s, double rate_hz);
/// The same of a plan in space.
[[nodiscard]] DOWNWASH_EXPORT std::vector<Setpoint> setpoints(const SpacePlan& plan, double end_s, double rate_hz);

}  // namespace downwash
