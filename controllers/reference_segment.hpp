#pragma once

#include <cstdint>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_point.hpp"

namespace downwash {

/// Limits of a reference: Euclidean over the translations, apart for every joint; all > 0.
struct MotionLimits {
    double max_speed_m_s = 1.0;
    double max_acceleration_m_s2 = 0.5;
    double max_arm_rate_rad_s = 0.7853981633974483;           ///< 45 degrees per second
    double max_arm_acceleration_rad_s2 = 1.5707963267948966;  ///< 90 degrees per second squared
    /// A multirotor turns to accelerate: its rotors swing as the jerk changes. 4 m/s^3 is PX4's MPC_JERK_AUTO.
    double max_jerk_m_s3 = 4;
    /// For agile flight: of the force that a point mass needs to follow the reference, |a + g|, as a multiple of its
    /// weight, > 1. The force must point upwards. Empty: any.
    std::optional<double> max_thrust_ratio;
    /// How fast that force, along which a multirotor points its rotors, may turn [rad/s], > 0. Empty: at any rate.
    std::optional<double> max_pitch_rate_rad_s;
};

/// The greatest rate of an axis [m/s or rad/s].
[[nodiscard]] inline double max_rate(const MotionLimits& limits, AxisGroup group) noexcept {
    return group == AxisGroup::translation ? limits.max_speed_m_s : limits.max_arm_rate_rad_s;
}

/// The greatest acceleration of an axis [m/s2 or rad/s2].
[[nodiscard]] inline double max_acceleration(const MotionLimits& limits, AxisGroup group) noexcept {
    return group == AxisGroup::translation ? limits.max_acceleration_m_s2 : limits.max_arm_acceleration_rad_s2;
}

/// The pitch at which a multirotor that is nothing but a point mass follows a reference [rad]: the direction of a + g.
[[nodiscard]] DOWNWASH_EXPORT double pitch_along(const ReferencePoint& point) noexcept;

/// Limits of a motion from rest to rest along a straight line, in whose quintic the acceleration points both ways: the
/// limit of acceleration is what a limit of the thrust leaves of it there.
/// @param way along each axis [m or rad], of any length; joints do not matter
[[nodiscard]] DOWNWASH_EXPORT MotionLimits limits_along(const MotionLimits& limits,
                                                        const double (&way)[max_axes]) noexcept;

/// Limits of acceleration and jerk that keep those of thrust and pitch rate whichever way a reference leads.
[[nodiscard]] DOWNWASH_EXPORT MotionLimits limits_in_every_direction(const MotionLimits& limits) noexcept;

/// One piece of a reference: the quintic Hermite polynomial between two points, a whole number of control ticks long.
/// Between two points at rest it is the straight line, all axes together, s(t) = 10 t^3 - 15 t^4 + 6 t^5.
class DOWNWASH_EXPORT ReferenceSegment {
 public:
    /// @param ticks length in control ticks, >= 1   @param tick_s length of a tick [s], > 0
    ReferenceSegment(const ReferencePoint& from, const ReferencePoint& to, std::int64_t ticks, double tick_s);

    [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
    [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
    [[nodiscard]] const ReferencePoint& from() const noexcept { return from_; }
    [[nodiscard]] const ReferencePoint& to() const noexcept { return to_; }

    /// The reference at the beginning of tick `tick`, 0 <= tick <= ticks(); exactly `from` and `to` at the ends.
    [[nodiscard]] ReferencePoint at_tick(std::int64_t tick) const noexcept;

    /// The largest jerk in (x, z) at its ends and at samples between them, at most 1 % below the true maximum [m/s^3].
    [[nodiscard]] double peak_jerk_m_s3() const noexcept;

    /// How fast the direction of a + g turns at the beginning of a tick, 0 <= tick <= ticks() [rad/s]; infinite where
    /// there is none.
    [[nodiscard]] double pitch_rate_rad_s(std::int64_t tick) const noexcept;
    /// How fast that direction turns, where at_tick(tick) is known already [rad/s].
    /// @param point at_tick(tick)
    [[nodiscard]] double pitch_rate_rad_s(std::int64_t tick, const ReferencePoint& point) const noexcept;

    /// The coefficients of the powers of the time over the duration, per axis; see quintic_at().
    [[nodiscard]] const double (&coefficients() const noexcept)[max_axes][6] { return coefficient_; }
    [[nodiscard]] double inverse_duration_1_s() const noexcept { return inverse_duration_1_s_; }

 private:
    ReferencePoint from_;
    ReferencePoint to_;
    std::int64_t ticks_;
    double tick_s_;
    double duration_s_;
    double inverse_duration_1_s_;
    double coefficient_[max_axes][6];  // of the powers of t / duration, per axis
};

/// A point that a reference passes at a control tick, counted from the start of the flight. Neighbouring knots span a
/// ReferenceSegment.
struct ReferenceKnot {
    std::int64_t tick = 0;
    ReferencePoint point;
};

/// The fewest ticks in which the quintic between two points keeps the limits; 1 if nothing moves.
/// If an end moves, the limits are checked at samples (kept to 0.3 %), and one tick less breaks them. If no duration
/// keeps them, the result is the one that breaks them least: check with keeps_limits().
[[nodiscard]] DOWNWASH_EXPORT std::int64_t shortest_ticks(const ReferencePoint& from, const ReferencePoint& to,
                                                          const MotionLimits& limits, double tick_s);

/// Whether speeds and accelerations at a point keep the limits; a point has no jerk. If they do not, no segment that
/// ends there does.
[[nodiscard]] DOWNWASH_EXPORT bool keeps_limits(const ReferencePoint& point, const MotionLimits& limits);

/// Whether a segment keeps the limits at all samples, its ends included.
[[nodiscard]] DOWNWASH_EXPORT bool keeps_limits(const ReferenceSegment& segment, const MotionLimits& limits);

/// Duration [s] of the rest-to-rest quintic over a distance [m] and an arm angle [rad] (peak speed 15/8 of the mean,
/// peak acceleration 10 / sqrt(3) of distance / duration^2, peak jerk 60 of distance / duration^3), before it is
/// rounded up to ticks.
[[nodiscard]] DOWNWASH_EXPORT double rest_to_rest_duration_s(double distance_m, double arm_rad,
                                                             const MotionLimits& limits);

}  // namespace downwash
