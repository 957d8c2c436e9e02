#include "downwash/ompl_planners/reference_steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace downwash::planning {
namespace {

constexpr double wanted_step_s = 0.5;

/// Peaks over a step: the velocity follows 3 s^2 - 2 s^3.
constexpr double peak_acceleration = 1.5;  // of gain / duration
constexpr double peak_jerk = 6;            // of gain / duration^2

/// Way from a speed to rest in steps, each of which takes away so much, the last one the remainder.
double braking_way(double speed, double gain, double step_s) {
    const double whole = std::floor(speed / gain);
    const double remainder = speed - whole * gain;
    return step_s * (whole * speed - 0.5 * gain * whole * whole + 0.5 * remainder);
}

// Limits of the axis with a number.

double rate_limit(const MotionLimits& limits, std::size_t /*number*/, AxisGroup group) {
    return max_rate(limits, group);
}
double rate_limit(const SpaceMotionLimits& limits, std::size_t number, AxisGroup /*group*/) {
    return max_rate(limits, static_cast<int>(number));
}
double acceleration_limit(const MotionLimits& limits, std::size_t /*number*/, AxisGroup group) {
    return max_acceleration(limits, group);
}
double acceleration_limit(const SpaceMotionLimits& limits, std::size_t number, AxisGroup /*group*/) {
    return max_acceleration(limits, static_cast<int>(number));
}

}  // namespace

template <class Family>
ReferenceStepsOf<Family>::ReferenceStepsOf(const MotionLimits& limits, double tick_s)
    : limits_(limits_in_every_direction(limits)),
      ticks_(std::max<std::int64_t>(1, std::llround(wanted_step_s / tick_s))),
      duration_s_(static_cast<double>(ticks_) * tick_s) {}

template <class Family>
void ReferenceStepsOf<Family>::add(AxisGroup group) {
    const std::size_t number = axes_.size();
    double gain = acceleration_limit(limits_, number, group) * duration_s_ / peak_acceleration;
    if (group == AxisGroup::translation) {
        gain = std::min(gain, limits_.max_jerk_m_s3 * duration_s_ * duration_s_ / peak_jerk);
    }
    axes_.push_back({group, rate_limit(limits_, number, group), gain});
}

/// The length of the translations among some rates.
template <class Family>
double ReferenceStepsOf<Family>::speed_of(const double* rates) const noexcept {
    double squares = 0;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (axes_[axis].group == AxisGroup::translation) {
            squares += rates[axis] * rates[axis];
        }
    }
    return std::sqrt(squares);
}

/// Shortens the translations together to their limit and each angle to its own; leaves shorter ones alone.
template <class Family>
void ReferenceStepsOf<Family>::shorten(double* rates, double StepAxis::*limit) const noexcept {
    const double now = speed_of(rates);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        const double most = axes_[axis].*limit;
        if (axes_[axis].group != AxisGroup::translation) {
            rates[axis] = std::clamp(rates[axis], -most, most);
        } else if (now > most) {
            rates[axis] *= most / now;
        }
    }
}

template <class Family>
auto ReferenceStepsOf<Family>::after(const ReferencePoint& from, const double* velocity) const noexcept
    -> ReferencePoint {
    double wanted[std::size(ReferencePoint{}.velocity)]{}, gain[std::size(ReferencePoint{}.velocity)]{};
    std::copy_n(velocity, axes_.size(), wanted);
    shorten(wanted, &StepAxis::max_rate);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        gain[axis] = wanted[axis] - from.velocity[axis];
    }
    shorten(gain, &StepAxis::gain);
    ReferencePoint next;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        next.velocity[axis] = from.velocity[axis] + gain[axis];
        next.position[axis] = from.position[axis] + duration_s_ * (from.velocity[axis] + 0.5 * gain[axis]);
    }
    return next;
}

template <class Family>
double ReferenceStepsOf<Family>::braking_ticks(const ReferencePoint& from) const noexcept {
    const double speed = speed_of(from.velocity);
    double steps = 0;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        const bool is_translation = axes_[axis].group == AxisGroup::translation;
        const double rate = is_translation ? speed : std::abs(from.velocity[axis]);
        steps = std::max(steps, std::ceil(rate / axes_[axis].gain));
    }
    return static_cast<double>(ticks_) * steps;
}

template <class Family>
auto ReferenceStepsOf<Family>::rest_of(const ReferencePoint& from) const noexcept -> Configuration {
    const double speed = speed_of(from.velocity);
    Configuration rest{};
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        const bool is_translation = axes_[axis].group == AxisGroup::translation;
        const double rate = is_translation ? speed : std::abs(from.velocity[axis]);
        const double braking_s = rate > 0 ? braking_way(rate, axes_[axis].gain, duration_s_) / rate : 0;
        rest[axis] = from.position[axis] + braking_s * from.velocity[axis];
    }
    return rest;
}

template class ReferenceStepsOf<Plane>;
template class ReferenceStepsOf<Space>;

}  // namespace downwash::planning
