#pragma once

#include <algorithm>
#include <array>

#include "downwash/controllers/reference_point.hpp"

namespace downwash {

/// Where the level vehicle and its arm are, or are asked to be: one number for each axis [m or rad]. Angles are
/// unwrapped; those of the arm are relative to the multirotor.
struct Configuration {
    std::array<double, max_axes> coordinate{};

    [[nodiscard]] constexpr double& operator[](std::size_t axis) noexcept { return coordinate[axis]; }
    [[nodiscard]] constexpr double operator[](std::size_t axis) const noexcept { return coordinate[axis]; }

    friend bool operator==(const Configuration&, const Configuration&) = default;
};

/// The reference that rests at a configuration.
[[nodiscard]] inline ReferencePoint at_rest(const Configuration& configuration) noexcept {
    ReferencePoint point;
    std::copy_n(configuration.coordinate.begin(), max_axes, point.position);
    return point;
}

/// The configuration of a reference point.
[[nodiscard]] inline Configuration configuration_of(const ReferencePoint& point) noexcept {
    Configuration configuration;
    std::copy_n(point.position, max_axes, configuration.coordinate.begin());
    return configuration;
}

/// Whether a reference point neither moves nor accelerates.
[[nodiscard]] inline bool is_at_rest(const ReferencePoint& point) noexcept {
    return point == at_rest(configuration_of(point));
}

/// The configuration of a planar vehicle with q = (x, z, pitch, arm) [m, m, rad, rad].
[[nodiscard]] inline Configuration configuration_of(const double (&q)[4]) noexcept {
    return {q[0], q[1], q[3]};
}

}  // namespace downwash
