#include "downwash/rivals/reference_steps.hpp"

#include <algorithm>
#include <cmath>

namespace downwash::planning {
namespace {

constexpr double wanted_step_s = 0.5;

/// Peaks over a step: the velocity follows 3 s^2 - 2 s^3.
constexpr double peak_acceleration = 1.5;  // of gain / duration
constexpr double peak_jerk = 6;            // of gain / duration^2

/// Shortens a vector to a length; leaves shorter ones alone.
void shorten(double& x, double& z, double length) {
    const double now = std::sqrt(x * x + z * z);
    if (now > length) {
        x *= length / now;
        z *= length / now;
    }
}

double speed_of(const ReferencePoint& point) {
    return std::sqrt(point.velocity[0] * point.velocity[0] + point.velocity[1] * point.velocity[1]);
}

/// Way from a speed to rest in steps, each of which takes away so much, the last one the remainder.
double braking_way(double speed, double gain, double step_s) {
    const double whole = std::floor(speed / gain);
    const double remainder = speed - whole * gain;
    return step_s * (whole * speed - 0.5 * gain * whole * whole + 0.5 * remainder);
}

}  // namespace

ReferenceSteps::ReferenceSteps(const MotionLimits& limits, double tick_s)
    : limits_(limits_in_every_direction(limits)),
      ticks_(std::max<std::int64_t>(1, std::llround(wanted_step_s / tick_s))),
      duration_s_(static_cast<double>(ticks_) * tick_s),
      speed_gain_m_s_(std::min(limits_.max_acceleration_m_s2 * duration_s_ / peak_acceleration,
                               limits_.max_jerk_m_s3 * duration_s_ * duration_s_ / peak_jerk)),
      arm_gain_rad_s_(limits.max_arm_acceleration_rad_s2 * duration_s_ / peak_acceleration) {}

ReferencePoint ReferenceSteps::after(const ReferencePoint& from, const double velocity[3]) const noexcept {
    double x = velocity[0];
    double z = velocity[1];
    shorten(x, z, limits_.max_speed_m_s);
    double gain_x = x - from.velocity[0];
    double gain_z = z - from.velocity[1];
    shorten(gain_x, gain_z, speed_gain_m_s_);
    const double arm = std::clamp(velocity[2], -limits_.max_arm_rate_rad_s, limits_.max_arm_rate_rad_s);
    const double gain[3] = {gain_x, gain_z, std::clamp(arm - from.velocity[2], -arm_gain_rad_s_, arm_gain_rad_s_)};
    ReferencePoint next;
    for (int axis = 0; axis < 3; ++axis) {
        next.velocity[axis] = from.velocity[axis] + gain[axis];
        next.position[axis] = from.position[axis] + duration_s_ * (from.velocity[axis] + 0.5 * gain[axis]);
    }
    return next;
}

double ReferenceSteps::braking_ticks(const ReferencePoint& from) const noexcept {
    return static_cast<double>(ticks_) * std::max(std::ceil(speed_of(from) / speed_gain_m_s_),
                                                  std::ceil(std::abs(from.velocity[2]) / arm_gain_rad_s_));
}

Configuration ReferenceSteps::rest_of(const ReferencePoint& from) const noexcept {
    const double speed = speed_of(from);
    const double braking_s = speed > 0 ? braking_way(speed, speed_gain_m_s_, duration_s_) / speed : 0;
    const double arm = std::abs(from.velocity[2]);
    const double arm_braking_s = arm > 0 ? braking_way(arm, arm_gain_rad_s_, duration_s_) / arm : 0;
    return {from.position[0] + braking_s * from.velocity[0], from.position[1] + braking_s * from.velocity[1],
            from.position[2] + arm_braking_s * from.velocity[2]};
}

}  // namespace downwash::planning
