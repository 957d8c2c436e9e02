#include "downwash/controllers/space_duration.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/controllers/space_translation.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {
namespace {

using controllers::axes;
using controllers::length;
using controllers::translation;

/// What limits alone say of the duration of a motion between two points, whichever quintics lead from one to the other:
/// cheap conditions that a duration has to meet.
class PossibleDurations {
 public:
    PossibleDurations(const SpacePoint& from, const SpacePoint& to, const SpaceMotionLimits& limits)
        : from_(from), to_(to), limits_(limits) {
        max_acceleration_m_s2_ = limits.max_acceleration_m_s2;
        if (limits.max_thrust_ratio) {  // |a| <= |a + g| + g
            max_acceleration_m_s2_ =
                std::min(max_acceleration_m_s2_, (*limits.max_thrust_ratio + 1) * standard_gravity_m_s2);
        }
        const Vector3 turn = translation(to.acceleration) - translation(from.acceleration);
        shortest_s_ = std::max({length(translation(to.position) - translation(from.position)) / limits.max_speed_m_s,
                                length(translation(to.velocity) - translation(from.velocity)) / max_acceleration_m_s2_,
                                length(turn) / limits.max_jerk_m_s3});
        // A polynomial of degree n within V over a duration T has a derivative of at most 2 n^2 V / T (A. A. Markov).
        const auto longest = [](double rate, double acceleration_1, double acceleration_2) {
            return 32 * rate / std::max(acceleration_1, acceleration_2);  // infinite if neither end accelerates
        };
        longest_s_ =
            longest(limits.max_speed_m_s, length(translation(from.acceleration)), length(translation(to.acceleration)));
        for (int axis = space::yaw; axis < axes; ++axis) {
            shortest_s_ =
                std::max({shortest_s_, std::abs(to.position[axis] - from.position[axis]) / max_rate(limits, axis),
                          std::abs(to.velocity[axis] - from.velocity[axis]) / max_acceleration(limits, axis)});
            longest_s_ = std::min(longest_s_, longest(max_rate(limits, axis), std::abs(from.acceleration[axis]),
                                                      std::abs(to.acceleration[axis])));
        }
    }

    [[nodiscard]] double shortest_s() const { return shortest_s_; }
    [[nodiscard]] double longest_s() const { return longest_s_; }

    /// Whether a duration is long enough to go aside from the mean of both ends' velocities as far as it takes: with
    /// |a| <= A by A T^2 / 4 and with |da/dt| <= J by J T^3 / 12 at most.
    [[nodiscard]] bool allow(double t_s) const {
        constexpr double with_rounding = 1 + 1e-6;
        const auto aside = [&](int axis) {
            return to_.position[axis] - from_.position[axis] - 0.5 * t_s * (from_.velocity[axis] + to_.velocity[axis]);
        };
        const double quarter = 0.25 * t_s * t_s * with_rounding;
        if (length({aside(space::x), aside(space::y), aside(space::z)}) >
            std::min(quarter * max_acceleration_m_s2_, quarter * t_s / 3 * limits_.max_jerk_m_s3)) {
            return false;
        }
        for (int axis = space::yaw; axis < axes; ++axis) {
            if (std::abs(aside(axis)) > quarter * max_acceleration(limits_, axis)) {
                return false;
            }
        }
        return true;
    }

 private:
    const SpacePoint& from_;
    const SpacePoint& to_;
    const SpaceMotionLimits& limits_;
    double max_acceleration_m_s2_;
    double shortest_s_;
    double longest_s_;
};

}  // namespace

double rest_to_rest_duration_s(const double (&way)[axes], const SpaceMotionLimits& limits) noexcept {
    constexpr double peak_speed = 15.0 / 8.0;
    constexpr double peak_acceleration = 5.7735026918962576;  // 10 / sqrt(3)
    constexpr double peak_jerk = 60;
    const double distance_m = length(translation(way));
    double by_rate = peak_speed * distance_m / limits.max_speed_m_s;
    double by_acceleration = peak_acceleration * distance_m / limits.max_acceleration_m_s2;
    for (int axis = space::yaw; axis < axes; ++axis) {
        by_rate = std::max(by_rate, peak_speed * std::abs(way[axis]) / max_rate(limits, axis));
        by_acceleration =
            std::max(by_acceleration, peak_acceleration * std::abs(way[axis]) / max_acceleration(limits, axis));
    }
    const double duration_s = std::max(by_rate, std::sqrt(by_acceleration));
    const double by_jerk = peak_jerk * distance_m / limits.max_jerk_m_s3;
    // Hardly ever what counts, and a cube root takes long.
    return by_jerk > duration_s * duration_s * duration_s ? std::max(duration_s, lane::cube_root(by_jerk)) : duration_s;
}

std::int64_t shortest_ticks(const SpacePoint& from, const SpacePoint& to, const SpaceMotionLimits& limits,
                            double tick_s) noexcept {
    constexpr std::int64_t max_ticks = std::int64_t{1} << 50;  // beyond any flight, and exact as a double
    // A hair less than the exact duration must not cost a whole tick.
    const auto ticks_of = [tick_s](double duration_s) {
        const double ticks = std::ceil(duration_s / tick_s - 1e-10);
        return ticks > 1 ? static_cast<std::int64_t>(std::min(ticks, static_cast<double>(max_ticks))) : 1;
    };
    const PossibleDurations possible(from, to, limits);
    std::int64_t ticks = ticks_of(possible.shortest_s());
    if (is_at_rest(from) && is_at_rest(to)) {
        double way[axes];
        for (int axis = 0; axis < axes; ++axis) {
            way[axis] = to.position[axis] - from.position[axis];
        }
        ticks = ticks_of(rest_to_rest_duration_s(way, limits_along(limits, way)));
        if (!limits.max_tilt_rate_rad_s) {
            return ticks;
        }
    }
    // With a moving end, or a limit of the tilt rate, the shortest time has no closed form: begin with less than any
    // motion within the limits needs, stretch until they are kept, then close in on the last step.
    const auto segment_in = [&](std::int64_t count) { return SpaceSegment(from, to, count, tick_s); };
    const auto is_enough = [&](std::int64_t count) { return keeps_limits(segment_in(count), limits); };
    const auto close_in = [&](std::int64_t too_few, std::int64_t enough) {
        while (enough - too_few > 1) {
            const std::int64_t middle = too_few + (enough - too_few) / 2;
            (is_enough(middle) ? enough : too_few) = middle;
        }
        return enough;
    };
    const auto longer = [](std::int64_t count) { return count + std::max<std::int64_t>(1, count / 16); };
    constexpr int max_trials = 60;
    int trials = 0;
    std::int64_t first = ticks;
    std::int64_t last = ticks;
    for (std::int64_t too_few = ticks - 1; trials < max_trials && ticks < max_ticks; ticks = longer(ticks)) {
        const double duration_s = static_cast<double>(ticks) * tick_s;
        if (trials > 0 && duration_s > possible.longest_s()) {
            break;
        }
        if (possible.allow(duration_s)) {
            if (is_enough(ticks)) {
                return close_in(too_few, ticks);
            }
            first = trials++ == 0 ? ticks : first;
            last = ticks;
        }
        too_few = ticks;
    }
    // None of those tried: look for the one that breaks the limits least.
    std::int64_t low = first;
    std::int64_t high = last;
    while (high - low > 2) {
        const std::int64_t third = (high - low) / 3;
        if (use_of_limits(segment_in(low + third), limits) <= use_of_limits(segment_in(high - third), limits)) {
            high -= third;
        } else {
            low += third;
        }
    }
    const std::int64_t best = low + (high - low) / 2;
    return is_enough(best) ? close_in(first, best) : best;
}

}  // namespace downwash
