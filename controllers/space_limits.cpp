#include "downwash/controllers/space_limits.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/infinity.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/bernstein.hpp"
#include "downwash/controllers/quintic.hpp"
#include "downwash/controllers/space_translation.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {
namespace {

using controllers::axes;
using controllers::Bernstein;
using controllers::length;
using controllers::translation;

/// Beyond a limit by no more than rounding.
constexpr double kept = 1 + 1e-9;
/// A force below this, over the weight, has no direction worth the name.
constexpr double min_force_ratio = 0.005;
constexpr Vector3 gravity = {0, 0, standard_gravity_m_s2};

/// Whether a vector of polynomials is nowhere longer than a limit. It lies within the hull of its coefficients.
template <std::size_t size, std::size_t dimensions>
bool is_within(const std::array<std::array<double, size>, dimensions>& vector, double limit) {
    const double max_square = (kept * limit) * (kept * limit);
    bool is_hull_within = true;
    for (std::size_t k = 0; k < size; ++k) {
        double square = 0;
        for (const auto& part : vector) {
            square += part[k] * part[k];
        }
        is_hull_within = is_hull_within && square <= max_square;
    }
    return is_hull_within ||
           controllers::is_at_most(controllers::squared_length(vector), max_square) == controllers::Bound::kept;
}

/// Whether a polynomial is nowhere below a limit.
template <std::size_t size>
bool is_at_least(std::array<double, size> p, double limit) {
    for (double& coefficient : p) {
        coefficient = -coefficient;
    }
    return controllers::is_at_most(p, -limit) == controllers::Bound::kept;
}

/// The first derivative by time of some axes.
template <int count>
std::array<Bernstein<4>, count> velocity_of(const SpaceSegment& segment, int first_axis) {
    std::array<Bernstein<4>, count> velocity;
    for (int i = 0; i < count; ++i) {
        const double* c = segment.coefficients()[first_axis + i];
        const double r = segment.inverse_duration_1_s();
        velocity[static_cast<std::size_t>(i)] =
            controllers::from_powers<5>({c[1] * r, 2 * c[2] * r, 3 * c[3] * r, 4 * c[4] * r, 5 * c[5] * r});
    }
    return velocity;
}

/// The derivative by time of each part.
template <std::size_t size, std::size_t dimensions>
std::array<std::array<double, size - 1>, dimensions> derivative_of(
    const std::array<std::array<double, size>, dimensions>& vector, double inverse_duration_1_s) {
    std::array<std::array<double, size - 1>, dimensions> derivative;
    for (std::size_t i = 0; i < dimensions; ++i) {
        derivative[i] = controllers::derivative(vector[i], inverse_duration_1_s);
    }
    return derivative;
}

/// Whether the direction of a force turns no faster than a rate: |f x f'|^2 <= rate^2 |f|^4, where there is a force.
bool keeps_tilt_rate(const std::array<Bernstein<3>, 3>& f, const std::array<Bernstein<2>, 3>& jerk, double rate_rad_s) {
    // Most flights are so gentle that the greatest jerk over the least force is within the rate.
    const double least_up = *std::min_element(f[2].begin(), f[2].end());
    constexpr double min_force = min_force_ratio * standard_gravity_m_s2;
    const double gentle = rate_rad_s * least_up;
    if (least_up >= min_force) {
        bool is_gentle = true;
        for (std::size_t k = 0; k < 3; ++k) {
            is_gentle = is_gentle &&
                        jerk[0][k] * jerk[0][k] + jerk[1][k] * jerk[1][k] + jerk[2][k] * jerk[2][k] <= gentle * gentle;
        }
        if (is_gentle) {
            return true;
        }
    }
    const Bernstein<6> square = controllers::squared_length(f);
    if (!is_at_least(square, min_force * min_force)) {
        return false;
    }
    std::array<Bernstein<5>, 3> turn{};  // f x f'
    for (std::size_t i = 0; i < 3; ++i) {
        controllers::add_product(turn[i], 1, f[(i + 1) % 3], jerk[(i + 2) % 3]);
        controllers::add_product(turn[i], -1, f[(i + 2) % 3], jerk[(i + 1) % 3]);
    }
    constexpr Bernstein<2> one{1, 1, 1};
    Bernstein<12> excess = controllers::product(one, controllers::squared_length(turn));
    controllers::add_product(excess, -(kept * rate_rad_s) * (kept * rate_rad_s), square, square);
    return controllers::is_at_most(excess, 0) == controllers::Bound::kept;
}

bool translation_keeps_limits(const SpaceSegment& segment, const SpaceMotionLimits& limits) {
    const double r = segment.inverse_duration_1_s();
    const auto velocity = velocity_of<3>(segment, space::x);
    auto acceleration = derivative_of(velocity, r);
    const auto jerk = derivative_of(acceleration, r);
    if (!is_within(jerk, limits.max_jerk_m_s3) || !is_within(acceleration, limits.max_acceleration_m_s2) ||
        !is_within(velocity, limits.max_speed_m_s)) {
        return false;
    }
    if (!limits.max_thrust_ratio && !limits.max_tilt_rate_rad_s) {
        return true;
    }
    auto& f = acceleration;
    for (double& coefficient : f[2]) {
        coefficient += standard_gravity_m_s2;
    }
    if (limits.max_thrust_ratio) {
        if (!is_within(f, *limits.max_thrust_ratio * standard_gravity_m_s2) || !is_at_least(f[2], 0)) {
            return false;
        }
    }
    return !limits.max_tilt_rate_rad_s || keeps_tilt_rate(f, jerk, *limits.max_tilt_rate_rad_s);
}

/// Whether an axis neither moves nor turns.
bool is_still(const SpaceSegment& segment, int axis) {
    const double* c = segment.coefficients()[axis];
    return std::all_of(c + 1, c + 6, [](double coefficient) { return coefficient == 0; });
}

bool angle_keeps_limits(const SpaceSegment& segment, int axis, const SpaceMotionLimits& limits) {
    if (is_still(segment, axis)) {
        return true;
    }
    const auto rate = velocity_of<1>(segment, axis);
    return is_within(rate, max_rate(limits, axis)) &&
           is_within(derivative_of(rate, segment.inverse_duration_1_s()), max_acceleration(limits, axis));
}

}  // namespace

SpaceMotionLimits limits_along(const SpaceMotionLimits& limits, const double (&way)[axes]) noexcept {
    const double distance_m = length(translation(way));
    if (!limits.max_thrust_ratio || !(distance_m > 0)) {
        return limits;
    }
    // |a e + g|^2 = a^2 + 2 a g e_z + g^2 is largest where a points as far up as it can; where it points down,
    // something has to be left of g.
    constexpr double largest_fall = 0.99;
    const double up = std::abs(way[space::z]) / distance_m;
    const double spare = *limits.max_thrust_ratio * *limits.max_thrust_ratio - 1;
    SpaceMotionLimits along = limits;
    along.max_acceleration_m_s2 =
        std::min({limits.max_acceleration_m_s2, standard_gravity_m_s2 * (std::sqrt(up * up + spare) - up),
                  up > 0 ? standard_gravity_m_s2 * largest_fall / up : infinity});
    return along;
}

SpaceMotionLimits limits_in_every_direction(const SpaceMotionLimits& limits) noexcept {
    SpaceMotionLimits all = limits_along(limits, {0, 0, 1});
    if (limits.max_tilt_rate_rad_s) {
        // The direction of a force turns by its change over its size at most.
        all.max_acceleration_m_s2 = std::min(all.max_acceleration_m_s2, 0.9 * standard_gravity_m_s2);
        const double min_force_m_s2 = standard_gravity_m_s2 - all.max_acceleration_m_s2;
        all.max_jerk_m_s3 = std::min(all.max_jerk_m_s3, *limits.max_tilt_rate_rad_s * min_force_m_s2);
    }
    return all;
}

bool keeps_limits(const SpacePoint& point, const SpaceMotionLimits& limits) noexcept {
    const Vector3 f = translation(point.acceleration) + gravity;
    if (!(length(translation(point.velocity)) <= kept * limits.max_speed_m_s) ||
        !(length(translation(point.acceleration)) <= kept * limits.max_acceleration_m_s2) ||
        (limits.max_thrust_ratio &&
         !(f[2] > 0 && length(f) <= kept * *limits.max_thrust_ratio * standard_gravity_m_s2)) ||
        (limits.max_tilt_rate_rad_s && !(length(f) >= min_force_ratio * standard_gravity_m_s2))) {
        return false;
    }
    for (int axis = space::yaw; axis < axes; ++axis) {
        if (!(std::abs(point.velocity[axis]) <= kept * max_rate(limits, axis)) ||
            !(std::abs(point.acceleration[axis]) <= kept * max_acceleration(limits, axis))) {
            return false;
        }
    }
    return true;
}

bool keeps_limits(const SpaceSegment& segment, const SpaceMotionLimits& limits) noexcept {
    if (!keeps_limits(segment.from(), limits) || !keeps_limits(segment.to(), limits) ||
        !translation_keeps_limits(segment, limits)) {
        return false;
    }
    for (int axis = space::yaw; axis < axes; ++axis) {
        if (!angle_keeps_limits(segment, axis, limits)) {
            return false;
        }
    }
    return true;
}

double use_of_limits(const SpaceSegment& segment, const SpaceMotionLimits& limits) noexcept {
    constexpr int samples = 32;
    const double r = segment.inverse_duration_1_s();
    double use = 0;
    for (int i = 0; i <= samples; ++i) {
        const double s = static_cast<double>(i) / samples;
        Vector3 velocity, acceleration, jerk;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double* c = segment.coefficients()[axis];
            const auto at = controllers::quintic_at(segment.coefficients()[axis], s, r);
            velocity[axis] = at.velocity;
            acceleration[axis] = at.acceleration;
            jerk[axis] = (6 * c[3] + s * (24 * c[4] + s * (60 * c[5]))) * r * r * r;
        }
        use = std::max({use, length(velocity) / limits.max_speed_m_s,
                        length(acceleration) / limits.max_acceleration_m_s2, length(jerk) / limits.max_jerk_m_s3});
        const Vector3 f = acceleration + gravity;
        if (limits.max_thrust_ratio) {
            use = std::max(use, f[2] > 0 ? length(f) / (*limits.max_thrust_ratio * standard_gravity_m_s2) : infinity);
        }
        if (limits.max_tilt_rate_rad_s) {
            const double square = dot(f, f);
            use =
                std::max(use, square > 0 ? length(cross(f, jerk)) / (square * *limits.max_tilt_rate_rad_s) : infinity);
        }
    }
    for (int axis = space::yaw; axis < axes; ++axis) {
        for (int i = 0; i <= samples && !is_still(segment, axis); ++i) {
            const double s = static_cast<double>(i) / samples;
            const auto at = controllers::quintic_at(segment.coefficients()[axis], s, r);
            use = std::max({use, std::abs(at.velocity) / max_rate(limits, axis),
                            std::abs(at.acceleration) / max_acceleration(limits, axis)});
        }
    }
    return use;
}

}  // namespace downwash
