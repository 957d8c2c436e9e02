#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_segment.hpp"

namespace downwash {

/// Limits of a reference in space; all > 0. Speed, acceleration and jerk are Euclidean over x, y and z; yaw and every
/// joint have their own.
struct SpaceMotionLimits {
    double max_speed_m_s = 1.0;
    double max_acceleration_m_s2 = 0.5;
    double max_jerk_m_s3 = 4;  ///< PX4's MPC_JERK_AUTO
    /// For agile flight: of the force that a point mass needs to follow the reference, |a + g|, as a multiple of its
    /// weight, > 1. The force must point upwards. Empty: any.
    std::optional<double> max_thrust_ratio;
    /// How fast that force, along which a multirotor points its rotors, may turn [rad/s], > 0. There must be such a
    /// force, at least 0.005 of the weight. Empty: at any rate.
    std::optional<double> max_tilt_rate_rad_s;
    double max_yaw_rate_rad_s = 0.7853981633974483;           ///< 45 degrees per second, PX4's MPC_YAWRAUTO_MAX
    double max_yaw_acceleration_rad_s2 = 1.0471975511965976;  ///< 60 degrees per second squared, PX4's MPC_YAWRAUTO_ACC
    std::array<double, max_joints> max_joint_rate_rad_s = every(0.7853981633974483);           ///< 45 degrees/s
    std::array<double, max_joints> max_joint_acceleration_rad_s2 = every(1.5707963267948966);  ///< 90 degrees/s2

    /// The same limit for every joint.
    [[nodiscard]] static constexpr std::array<double, max_joints> every(double limit) noexcept {
        std::array<double, max_joints> limits{};
        limits.fill(limit);
        return limits;
    }
};

/// The greatest rate of an axis [m/s or rad/s]; that of x, y and z is of all three together.
[[nodiscard]] inline double max_rate(const SpaceMotionLimits& limits, int axis) noexcept {
    return axis < space::yaw    ? limits.max_speed_m_s
           : axis == space::yaw ? limits.max_yaw_rate_rad_s
                                : limits.max_joint_rate_rad_s[static_cast<std::size_t>(axis - space::first_joint)];
}

/// The greatest acceleration of an axis [m/s2 or rad/s2]; that of x, y and z is of all three together.
[[nodiscard]] inline double max_acceleration(const SpaceMotionLimits& limits, int axis) noexcept {
    return axis < space::yaw ? limits.max_acceleration_m_s2
           : axis == space::yaw
               ? limits.max_yaw_acceleration_rad_s2
               : limits.max_joint_acceleration_rad_s2[static_cast<std::size_t>(axis - space::first_joint)];
}

/// Limits of a motion from rest to rest along a straight line, in whose quintic the acceleration points both ways: the
/// limit of acceleration is what a limit of the thrust leaves of it there.
/// @param way along each axis [m or rad], of any length; only x, y and z matter
[[nodiscard]] DOWNWASH_EXPORT SpaceMotionLimits limits_along(const SpaceMotionLimits& limits,
                                                             const double (&way)[space_axes<max_joints>]) noexcept;

/// Limits of acceleration and jerk that keep those of thrust and tilt rate whichever way a reference leads.
[[nodiscard]] DOWNWASH_EXPORT SpaceMotionLimits limits_in_every_direction(const SpaceMotionLimits& limits) noexcept;

/// Whether speeds, accelerations and thrust at a point keep the limits; a point has neither jerk nor tilt rate. If they
/// do not, no segment that ends there does.
[[nodiscard]] DOWNWASH_EXPORT bool keeps_limits(const SpacePoint& point, const SpaceMotionLimits& limits) noexcept;

/// Whether a segment keeps the limits at every instant: proven by Bernstein coefficients, to 1e-9 of each limit. A
/// segment of which neither this nor the contrary can be proven (see controllers::is_at_most()) does not keep them.
[[nodiscard]] DOWNWASH_EXPORT bool keeps_limits(const SpaceSegment& segment, const SpaceMotionLimits& limits) noexcept;

/// The greatest ratio of a quantity to its limit at 33 instants of a segment, the ends included; infinite where a limit
/// asks for a force and there is none.
[[nodiscard]] DOWNWASH_EXPORT double use_of_limits(const SpaceSegment& segment,
                                                   const SpaceMotionLimits& limits) noexcept;

}  // namespace downwash
