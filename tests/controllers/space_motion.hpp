#pragma once

#include <algorithm>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/controllers/space_limits.hpp"
#include "downwash/controllers/space_segment.hpp"

// Random motions in space, and how far they use their limits: by dense samples in extended precision, from the
// coefficients alone.

namespace downwash::test {

inline constexpr int all_axes = space_axes<max_joints>;

/// Ends of a motion: coordinates within `size`, rates and accelerations of each axis within the others.
inline SpacePoint random_space_point(Random& random, int joints, double size, double rate, double acceleration) {
    SpacePoint point;
    for (int axis = 0; axis < 4 + joints; ++axis) {
        point.position[axis] = random.uniform(-size, size);
        point.velocity[axis] = random.uniform(-rate, rate);
        point.acceleration[axis] = random.uniform(-acceleration, acceleration);
    }
    return point;
}

/// Limits of an agile flight, in which every limit binds sometimes.
inline SpaceMotionLimits agile_space_limits() {
    SpaceMotionLimits limits;
    limits.max_speed_m_s = 4;
    limits.max_acceleration_m_s2 = 9;
    limits.max_jerk_m_s3 = 34;
    limits.max_thrust_ratio = 1.3;
    limits.max_tilt_rate_rad_s = 3;
    limits.max_yaw_rate_rad_s = 3;
    limits.max_yaw_acceleration_rad_s2 = 10;
    limits.max_joint_rate_rad_s = {3, 3, 2.5, 3, 3, 3};
    limits.max_joint_acceleration_rad_s2 = {10, 8, 9, 10, 10, 10};
    return limits;
}

/// The greatest ratio to each limit.
struct SpaceUse {
    double speed = 0, acceleration = 0, jerk = 0, thrust = 0, tilt_rate = 0, yaw = 0, joints = 0;
    bool has_force_upwards = true;

    [[nodiscard]] double greatest(const SpaceMotionLimits& limits) const {
        const double most = std::max({speed, acceleration, jerk, thrust, tilt_rate, yaw, joints});
        return has_force_upwards || !limits.max_thrust_ratio ? most : HUGE_VAL;
    }
};

inline SpaceUse use_by_samples(const SpaceSegment& segment, const SpaceMotionLimits& limits, int samples) {
    using Number = long double;
    constexpr Number g = 9.80665L;
    const Number r = 1 / static_cast<Number>(segment.duration_s());
    SpaceUse use;
    const auto raise = [](double& ratio, Number value) { ratio = std::max(ratio, static_cast<double>(value)); };
    const auto length = [](const Number(&v)[all_axes]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
    for (int i = 0; i <= samples; ++i) {
        const Number s = static_cast<Number>(i) / samples;
        Number v[all_axes];
        Number a[all_axes];
        Number j[all_axes];
        for (int axis = 0; axis < all_axes; ++axis) {
            const double* c = segment.coefficients()[axis];
            v[axis] = (c[1] + s * (2.0L * c[2] + s * (3.0L * c[3] + s * (4.0L * c[4] + s * 5.0L * c[5])))) * r;
            a[axis] = (2.0L * c[2] + s * (6.0L * c[3] + s * (12.0L * c[4] + s * 20.0L * c[5]))) * r * r;
            j[axis] = (6.0L * c[3] + s * (24.0L * c[4] + s * 60.0L * c[5])) * r * r * r;
        }
        raise(use.speed, length(v) / limits.max_speed_m_s);
        raise(use.acceleration, length(a) / limits.max_acceleration_m_s2);
        raise(use.jerk, length(j) / limits.max_jerk_m_s3);
        raise(use.yaw, std::abs(v[3]) / limits.max_yaw_rate_rad_s);
        raise(use.yaw, std::abs(a[3]) / limits.max_yaw_acceleration_rad_s2);
        for (std::size_t joint = 0; joint < max_joints; ++joint) {
            raise(use.joints, std::abs(v[4 + joint]) / limits.max_joint_rate_rad_s[joint]);
            raise(use.joints, std::abs(a[4 + joint]) / limits.max_joint_acceleration_rad_s2[joint]);
        }
        const Number up = a[2] + g;
        const Number square = a[0] * a[0] + a[1] * a[1] + up * up;
        use.has_force_upwards = use.has_force_upwards && up > 0;
        if (limits.max_thrust_ratio) {
            raise(use.thrust, std::sqrt(square) / (*limits.max_thrust_ratio * g));
        }
        if (limits.max_tilt_rate_rad_s) {
            const Number x = a[1] * j[2] - up * j[1];
            const Number y = up * j[0] - a[0] * j[2];
            const Number z = a[0] * j[1] - a[1] * j[0];
            raise(use.tilt_rate, std::sqrt(x * x + y * y + z * z) / square / *limits.max_tilt_rate_rad_s);
        }
    }
    return use;
}

}  // namespace downwash::test
