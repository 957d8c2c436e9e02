#pragma once

#include <functional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/exports/setpoint.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

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
