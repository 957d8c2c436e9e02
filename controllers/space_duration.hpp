#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_limits.hpp"
#include "downwash/controllers/space_reference.hpp"

// How long a motion in space takes.

namespace downwash {

/// Duration [s] of the rest-to-rest quintic, before it is rounded up to ticks: the greatest over translation, yaw and
/// each joint (peak speed 15/8 of the mean, peak acceleration 10 / sqrt(3) of distance / duration^2, peak jerk 60 of
/// distance / duration^3). It is a metric of configurations: each part is concave in its distance, rising, and zero
/// at zero. Limits of thrust and tilt rate do not count; see limits_along().
/// @param way along each axis [m or rad]
[[nodiscard]] DOWNWASH_EXPORT double rest_to_rest_duration_s(const double (&way)[space_axes<max_joints>],
                                                             const SpaceMotionLimits& limits) noexcept;

/// The fewest ticks in which the quintics between two points keep the limits; 1 if nothing moves. One tick less breaks
/// them. If an end moves, durations that keep them need not be one interval: a shorter one, between two that break
/// them and lie within 1/16 of each other, may be missed. If no duration keeps them, the result is about the one that
/// breaks them least: check with keeps_limits().
[[nodiscard]] DOWNWASH_EXPORT std::int64_t shortest_ticks(const SpacePoint& from, const SpacePoint& to,
                                                          const SpaceMotionLimits& limits, double tick_s) noexcept;

}  // namespace downwash
