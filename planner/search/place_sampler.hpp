#pragma once

#include <optional>

#include "downwash/controllers/configuration.hpp"

namespace downwash::planning {

/// Draws the places that a tree grows to, all over the space and beside others.
template <class Family>
class PlaceSamplerOf {
 public:
    using Configuration = typename Family::Configuration;

    PlaceSamplerOf() = default;
    virtual ~PlaceSamplerOf() = default;
    PlaceSamplerOf(const PlaceSamplerOf&) = delete;
    PlaceSamplerOf& operator=(const PlaceSamplerOf&) = delete;

    /// A place anywhere, or one through which a plan may cost less than `most`; nothing when none is found.
    [[nodiscard]] virtual std::optional<Configuration> anywhere(double most) = 0;
    /// A place at most `radius_m` beside another in each coordinate.
    [[nodiscard]] virtual Configuration near(const Configuration& place, double radius_m) = 0;
};
using PlaceSampler = PlaceSamplerOf<Plane>;

}  // namespace downwash::planning
