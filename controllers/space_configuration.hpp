#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

#include "downwash/controllers/space_reference.hpp"

namespace downwash {

/// Where the level vehicle in space and its arm are, or are asked to be: one number for each axis of SpacePoint
/// [m or rad]. Angles are unwrapped; those of joints that the vehicle lacks are 0.
struct SpaceConfiguration {
    std::array<double, space_axes<max_joints>> coordinate{};

    [[nodiscard]] constexpr double& operator[](std::size_t axis) noexcept { return coordinate[axis]; }
    [[nodiscard]] constexpr double operator[](std::size_t axis) const noexcept { return coordinate[axis]; }

    [[nodiscard]] constexpr auto begin() noexcept { return coordinate.begin(); }
    [[nodiscard]] constexpr auto begin() const noexcept { return coordinate.begin(); }
    [[nodiscard]] constexpr auto end() noexcept { return coordinate.end(); }
    [[nodiscard]] constexpr auto end() const noexcept { return coordinate.end(); }
    [[nodiscard]] static constexpr std::size_t size() noexcept { return space_axes<max_joints>; }

    friend bool operator==(const SpaceConfiguration&, const SpaceConfiguration&) = default;
};

/// The reference that rests at a configuration. A template, so that numbers in braces are a configuration in a plane.
template <std::same_as<SpaceConfiguration> Configuration>
[[nodiscard]] SpacePoint at_rest(const Configuration& configuration) noexcept {
    SpacePoint point;
    std::ranges::copy(configuration.coordinate, point.position);
    return point;
}

/// The configuration of a reference point.
[[nodiscard]] inline SpaceConfiguration configuration_of(const SpacePoint& point) noexcept {
    SpaceConfiguration configuration;
    std::ranges::copy(point.position, configuration.coordinate.begin());
    return configuration;
}

}  // namespace downwash
