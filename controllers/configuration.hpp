#pragma once

#include <algorithm>

#include "downwash/controllers/reference_point.hpp"

namespace downwash {

/// Where the level vehicle and its arm are, or are asked to be: a place in the plane of motion [m] and the angle of the
/// arm relative to the multirotor [rad], unwrapped.
struct Configuration {
    double x_m = 0;
    double z_m = 0;
    double arm_rad = 0;

    friend bool operator==(const Configuration&, const Configuration&) = default;
};

/// The reference at rest there.
[[nodiscard]] inline ReferencePoint at_rest(const Configuration& configuration) noexcept {
    ReferencePoint point;
    point.position[0] = configuration.x_m;
    point.position[1] = configuration.z_m;
    point.position[2] = configuration.arm_rad;
    return point;
}

/// Whether nothing moves: neither speed nor acceleration.
[[nodiscard]] inline bool is_at_rest(const ReferencePoint& point) noexcept {
    ReferencePoint still;
    std::copy_n(point.position, 3, still.position);
    return point == still;
}

/// Where a reference is.
[[nodiscard]] inline Configuration configuration_of(const ReferencePoint& point) noexcept {
    return {point.position[0], point.position[1], point.position[2]};
}

/// Where a vehicle with q = (x, z, pitch, arm) [m, m, rad, rad] is.
[[nodiscard]] inline Configuration configuration_of(const double (&q)[4]) noexcept {
    return {q[0], q[1], q[3]};
}

}  // namespace downwash
