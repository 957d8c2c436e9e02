#include "downwash/ompl_planners/reference_steps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace downwash::planning {
namespace {

constexpr double wanted_step_s = 0.5;

/// Peaks over a step: the velocity follows 3 s^2 - 2 s^3.
constexpr double peak_acceleration = 1.5;  // of gain / duration
constexpr double peak_jerk = 6;            // of gain / duration^2

/// The length of the translations among some rates.
double speed_of(const double rates[max_axes], std::span<const Axis> axes) {
    double squares = 0;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (axes[axis].group == AxisGroup::translation) {
            squares += rates[axis] * rates[axis];
        }
    }
    return std::sqrt(squares);
}

/// Shortens the translations together to a length and each joint to another; leaves shorter ones alone.
void shorten(double rates[max_axes], std::span<const Axis> axes, double length, double joint) {
    const double now = speed_of(rates, axes);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (axes[axis].group == AxisGroup::joint) {
            rates[axis] = std::clamp(rates[axis], -joint, joint);
        } else if (now > length) {
            rates[axis] *= length / now;
        }
    }
}

/// Way from a speed to rest in steps, each of which takes away so much, the last one the remainder.
double braking_way(double speed, double gain, double step_s) {
    const double whole = std::floor(speed / gain);
    const double remainder = speed - whole * gain;
    return step_s * (whole * speed - 0.5 * gain * whole * whole + 0.5 * remainder);
}

}  // namespace

ReferenceSteps::ReferenceSteps(std::span<const Axis> axes, const MotionLimits& limits, double tick_s)
    : axes_(axes),
      limits_(limits_in_every_direction(limits)),
      ticks_(std::max<std::int64_t>(1, std::llround(wanted_step_s / tick_s))),
      duration_s_(static_cast<double>(ticks_) * tick_s),
      speed_gain_m_s_(std::min(limits_.max_acceleration_m_s2 * duration_s_ / peak_acceleration,
                               limits_.max_jerk_m_s3 * duration_s_ * duration_s_ / peak_jerk)),
      arm_gain_rad_s_(limits.max_arm_acceleration_rad_s2 * duration_s_ / peak_acceleration) {}

ReferencePoint ReferenceSteps::after(const ReferencePoint& from, const double velocity[max_axes]) const noexcept {
    double wanted[max_axes], gain[max_axes];
    std::copy_n(velocity, max_axes, wanted);
    shorten(wanted, axes_, limits_.max_speed_m_s, limits_.max_arm_rate_rad_s);
    std::transform(wanted, wanted + max_axes, from.velocity, gain, std::minus{});
    shorten(gain, axes_, speed_gain_m_s_, arm_gain_rad_s_);
    ReferencePoint next;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        next.velocity[axis] = from.velocity[axis] + gain[axis];
        next.position[axis] = from.position[axis] + duration_s_ * (from.velocity[axis] + 0.5 * gain[axis]);
    }
    return next;
}

double ReferenceSteps::braking_ticks(const ReferencePoint& from) const noexcept {
    double steps = std::ceil(speed_of(from.velocity, axes_) / speed_gain_m_s_);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (axes_[axis].group == AxisGroup::joint) {
            steps = std::max(steps, std::ceil(std::abs(from.velocity[axis]) / arm_gain_rad_s_));
        }
    }
    return static_cast<double>(ticks_) * steps;
}

Configuration ReferenceSteps::rest_of(const ReferencePoint& from) const noexcept {
    const double speed = speed_of(from.velocity, axes_);
    Configuration rest;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        const bool is_joint = axes_[axis].group == AxisGroup::joint;
        const double rate = is_joint ? std::abs(from.velocity[axis]) : speed;
        const double gain = is_joint ? arm_gain_rad_s_ : speed_gain_m_s_;
        const double braking_s = rate > 0 ? braking_way(rate, gain, duration_s_) / rate : 0;
        rest[axis] = from.position[axis] + braking_s * from.velocity[axis];
    }
    return rest;
}

}  // namespace downwash::planning
