#include "downwash/controllers/reference_segment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/quintic.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {
namespace {

double translation_length(const double axis[3]) {
    return std::sqrt(axis[0] * axis[0] + axis[1] * axis[1]);
}

/// Beyond a limit by no more than rounding.
constexpr double kept = 1 + 1e-9;

/// a + g over g; infinite if it does not point upwards.
double thrust_ratio(const ReferencePoint& p) {
    const double force[2] = {p.acceleration[0] / standard_gravity_m_s2, 1 + p.acceleration[1] / standard_gravity_m_s2};
    return force[1] > 0 ? translation_length(force) : std::numeric_limits<double>::infinity();
}

double ratio_at(const ReferencePoint& p, const MotionLimits& limits) {
    const double ratio = std::max({translation_length(p.velocity) / limits.max_speed_m_s,
                                   translation_length(p.acceleration) / limits.max_acceleration_m_s2,
                                   std::abs(p.velocity[2]) / limits.max_arm_rate_rad_s,
                                   std::abs(p.acceleration[2]) / limits.max_arm_acceleration_rad_s2});
    return limits.max_thrust_ratio ? std::max(ratio, thrust_ratio(p) / *limits.max_thrust_ratio) : ratio;
}

std::int64_t samples_of(const ReferenceSegment& segment) {
    constexpr std::int64_t max_samples = 64;
    return std::min(max_samples, segment.ticks());
}

/// The largest ratio of a speed or an acceleration to its limit at a sample. Sample 0 is the segment's beginning.
double ratio_at_sample(const ReferenceSegment& segment, std::int64_t sample, const MotionLimits& limits) {
    const std::int64_t tick = segment.ticks() * sample / samples_of(segment);
    const ReferencePoint point = segment.at_tick(tick);
    const double ratio = ratio_at(point, limits);
    return limits.max_pitch_rate_rad_s
               ? std::max(ratio, std::abs(segment.pitch_rate_rad_s(tick, point)) / *limits.max_pitch_rate_rad_s)
               : ratio;
}

/// The same at the ends, where the acceleration is continuous and the rate of its direction need not be.
double pitch_rate_ratio_at_ends(const ReferenceSegment& segment, const MotionLimits& limits) {
    return limits.max_pitch_rate_rad_s
               ? std::max(std::abs(segment.pitch_rate_rad_s(0)), std::abs(segment.pitch_rate_rad_s(segment.ticks()))) /
                     *limits.max_pitch_rate_rad_s
               : 0;
}

/// The largest ratio at samples between the ends, and that of the jerk.
double worst_ratio(const ReferenceSegment& segment, const MotionLimits& limits) {
    double worst = std::max(segment.peak_jerk_m_s3() / limits.max_jerk_m_s3, pitch_rate_ratio_at_ends(segment, limits));
    for (std::int64_t i = 1; i < samples_of(segment); ++i) {
        worst = std::max(worst, ratio_at_sample(segment, i, limits));
    }
    return worst;
}

/// Whether the jerk, and all samples between the ends, keep the limits.
/// @param suspect the sample that is asked first, as it did not keep them last; becomes the one that does not
bool keeps_limits_between(const ReferenceSegment& segment, const MotionLimits& limits, std::int64_t& suspect) {
    if (segment.peak_jerk_m_s3() > kept * limits.max_jerk_m_s3 || pitch_rate_ratio_at_ends(segment, limits) > kept) {
        return false;
    }
    const std::int64_t samples = samples_of(segment);
    if (suspect < samples && ratio_at_sample(segment, suspect, limits) > kept) {
        return false;
    }
    for (std::int64_t i = 1; i < samples; ++i) {
        if (ratio_at_sample(segment, i, limits) > kept) {
            suspect = i;
            return false;
        }
    }
    return true;
}

}  // namespace

ReferenceSegment::ReferenceSegment(const ReferencePoint& from, const ReferencePoint& to, std::int64_t ticks,
                                   double tick_s)
    : from_(from),
      to_(to),
      ticks_(ticks),
      tick_s_(tick_s),
      duration_s_(static_cast<double>(ticks) * tick_s),
      inverse_duration_1_s_(1 / duration_s_) {
    assert(ticks >= 1 && tick_s > 0);
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        controllers::quintic_between<double>({from.position[axis], from.velocity[axis], from.acceleration[axis]},
                                             {to.position[axis], to.velocity[axis], to.acceleration[axis]}, duration_s_,
                                             coefficient_[axis]);
    }
}

ReferencePoint ReferenceSegment::at_tick(std::int64_t tick) const noexcept {
    if (tick <= 0) {
        return from_;
    }
    if (tick >= ticks_) {
        return to_;
    }
    const double s = static_cast<double>(tick) * tick_s_ * inverse_duration_1_s_;
    ReferencePoint point;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const auto at = controllers::quintic_at(coefficient_[axis], s, inverse_duration_1_s_);
        point.position[axis] = at.position;
        point.velocity[axis] = at.velocity;
        point.acceleration[axis] = at.acceleration;
    }
    return point;
}

double ReferenceSegment::peak_jerk_m_s3() const noexcept {
    constexpr int samples = 16;
    double largest = 0;  // squared, per duration^3
    for (int i = 0; i <= samples; ++i) {
        const double s = static_cast<double>(i) / samples;
        double square = 0;
        for (int axis = 0; axis < 2; ++axis) {
            const double* c = coefficient_[axis];
            const double jerk = 6 * c[3] + s * (24 * c[4] + s * (60 * c[5]));
            square += jerk * jerk;
        }
        largest = std::max(largest, square);
    }
    return std::sqrt(largest) * inverse_duration_1_s_ * inverse_duration_1_s_ * inverse_duration_1_s_;
}

double ReferenceSegment::pitch_rate_rad_s(std::int64_t tick) const noexcept {
    return pitch_rate_rad_s(tick, at_tick(tick));
}

double ReferenceSegment::pitch_rate_rad_s(std::int64_t tick, const ReferencePoint& point) const noexcept {
    const double s = static_cast<double>(std::clamp<std::int64_t>(tick, 0, ticks_)) * tick_s_ * inverse_duration_1_s_;
    const double per_duration3 = inverse_duration_1_s_ * inverse_duration_1_s_ * inverse_duration_1_s_;
    double jerk[2];
    for (int axis = 0; axis < 2; ++axis) {
        const double* c = coefficient_[axis];
        jerk[axis] = (6 * c[3] + s * (24 * c[4] + s * (60 * c[5]))) * per_duration3;
    }
    const double up = point.acceleration[1] + standard_gravity_m_s2;
    const double square = point.acceleration[0] * point.acceleration[0] + up * up;
    return square > 0 ? (up * jerk[0] - point.acceleration[0] * jerk[1]) / square
                      : std::numeric_limits<double>::infinity();
}

double pitch_along(const ReferencePoint& point) noexcept {
    return lane::atan2(point.acceleration[0], point.acceleration[1] + standard_gravity_m_s2);
}

MotionLimits limits_along(const MotionLimits& limits, const double (&way)[max_axes]) noexcept {
    const double distance_m = translation_length(way);
    if (!limits.max_thrust_ratio || !(distance_m > 0)) {
        return limits;
    }
    // |a e + g|^2 = a^2 + 2 a g e_z + g^2 is largest where a points as far up as it can; where it points down,
    // something has to be left of g.
    constexpr double largest_fall = 0.99;
    const double up = std::abs(way[plane::z]) / distance_m;
    const double spare = *limits.max_thrust_ratio * *limits.max_thrust_ratio - 1;
    MotionLimits along = limits;
    along.max_acceleration_m_s2 =
        std::min({limits.max_acceleration_m_s2, standard_gravity_m_s2 * (std::sqrt(up * up + spare) - up),
                  up > 0 ? standard_gravity_m_s2 * largest_fall / up : std::numeric_limits<double>::infinity()});
    return along;
}

MotionLimits limits_in_every_direction(const MotionLimits& limits) noexcept {
    MotionLimits all = limits_along(limits, {0, 1});
    if (limits.max_pitch_rate_rad_s) {
        // The direction of a force turns by its change over its size at most.
        all.max_acceleration_m_s2 = std::min(all.max_acceleration_m_s2, 0.9 * standard_gravity_m_s2);
        const double min_force_m_s2 = standard_gravity_m_s2 - all.max_acceleration_m_s2;
        all.max_jerk_m_s3 = std::min(all.max_jerk_m_s3, *limits.max_pitch_rate_rad_s * min_force_m_s2);
    }
    return all;
}

double rest_to_rest_duration_s(double distance_m, double arm_rad, const MotionLimits& limits) {
    constexpr double peak_speed = 15.0 / 8.0;
    constexpr double peak_acceleration = 5.7735026918962576;  // 10 / sqrt(3)
    constexpr double peak_jerk = 60;
    return std::max({peak_speed * distance_m / limits.max_speed_m_s,
                     std::sqrt(peak_acceleration * distance_m / limits.max_acceleration_m_s2),
                     std::cbrt(peak_jerk * distance_m / limits.max_jerk_m_s3),
                     peak_speed * arm_rad / limits.max_arm_rate_rad_s,
                     std::sqrt(peak_acceleration * arm_rad / limits.max_arm_acceleration_rad_s2)});
}

std::int64_t shortest_ticks(const ReferencePoint& from, const ReferencePoint& to, const MotionLimits& limits,
                            double tick_s) {
    double way[max_axes];
    std::transform(to.position, to.position + max_axes, from.position, way, std::minus{});
    const double distance_m = translation_length(way);
    const double arm_rad = std::abs(way[2]);
    // A hair less than the exact duration must not cost a whole tick.
    const auto ticks_of = [tick_s](double duration_s) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(duration_s / tick_s - 1e-9)));
    };
    const bool is_from_rest_to_rest = is_at_rest(from) && is_at_rest(to);
    std::int64_t ticks = ticks_of(
        rest_to_rest_duration_s(distance_m, arm_rad, is_from_rest_to_rest ? limits_along(limits, way) : limits));
    if (is_from_rest_to_rest && !limits.max_pitch_rate_rad_s) {
        return ticks;
    }
    // With a moving end, or a limit of the pitch rate, the shortest time has no closed form: begin with less than any
    // motion within the limits needs, stretch until they are kept, then close in on the last step.
    double change[max_axes];
    std::transform(to.velocity, to.velocity + max_axes, from.velocity, change, std::minus{});
    const double braking_s = std::max(translation_length(change) / limits.max_acceleration_m_s2,
                                      std::abs(change[2]) / limits.max_arm_acceleration_rad_s2);
    if (!is_from_rest_to_rest) {
        ticks = std::max(ticks_of(0.5 * rest_to_rest_duration_s(distance_m, arm_rad, limits)), ticks_of(braking_s));
    }
    const auto segment_in = [&](std::int64_t count) { return ReferenceSegment(from, to, count, tick_s); };
    std::int64_t suspect = 1;
    const auto is_enough = [&](std::int64_t count) { return keeps_limits_between(segment_in(count), limits, suspect); };
    constexpr int max_stretches = 60;
    std::vector<std::int64_t> too_short;
    while (!is_enough(ticks)) {
        too_short.push_back(ticks);
        if (too_short.size() == max_stretches) {
            const auto ratio_in = [&](std::int64_t count) { return worst_ratio(segment_in(count), limits); };
            return *std::min_element(too_short.begin(), too_short.end(),
                                     [&](std::int64_t a, std::int64_t b) { return ratio_in(a) < ratio_in(b); });
        }
        ticks += std::max<std::int64_t>(1, ticks / 16);
    }
    std::int64_t too_few = too_short.empty() ? ticks - 1 : too_short.back();
    while (ticks - too_few > 1) {
        const std::int64_t middle = too_few + (ticks - too_few) / 2;
        (is_enough(middle) ? ticks : too_few) = middle;
    }
    return ticks;
}

bool keeps_limits(const ReferencePoint& point, const MotionLimits& limits) {
    return ratio_at(point, limits) <= kept;
}

bool keeps_limits(const ReferenceSegment& segment, const MotionLimits& limits) {
    std::int64_t suspect = 1;
    return keeps_limits(segment.from(), limits) && keeps_limits(segment.to(), limits) &&
           keeps_limits_between(segment, limits, suspect);
}

}  // namespace downwash
