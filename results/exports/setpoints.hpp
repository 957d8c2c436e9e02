#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// The commanded motion of vehicle and arm at one time, in the world frame (x forward, y left, z up).
struct Setpoint {
    double t_s = 0;
    Vector3 position_m{};
    Vector3 velocity_m_s{};
    Vector3 acceleration_m_s2{};
    double yaw_rad = 0;  ///< about z, of the plane of motion; constant
    double arm_rad = 0;  ///< relative to the multirotor
    double arm_rate_rad_s = 0;
    double arm_acceleration_rad_s2 = 0;
};

/// The reference of a plan at every 1 / rate_hz from 0 on, and at its end. After the last knot it stays constant.
/// @param end_s of the flight, hover at the goal included; at least the plan's duration is used   @param rate_hz in (0,
/// 10000]
/// @throws InputError if there would be more than a million set-points, or the rate is out of range
[[nodiscard]] DOWNWASH_EXPORT std::vector<Setpoint> setpoints(const Plan& plan, const PlaneOfMotion& plane,
                                                              double end_s, double rate_hz);

}  // namespace downwash
