#pragma once

#include <optional>

#include "downwash/controllers/configuration.hpp"

namespace downwash::planning {

/// Draws the places that a tree grows to, all over the space and beside others.
class PlaceSampler {
 public:
    PlaceSampler() = default;
    virtual ~PlaceSampler() = default;
    PlaceSampler(const PlaceSampler&) = delete;
    PlaceSampler& operator=(const PlaceSampler&) = delete;

    /// A place anywhere, or one through which a plan may cost less than `most`; nothing when none is found.
    [[nodiscard]] virtual std::optional<Configuration> anywhere(double most) = 0;
    /// A place at most `radius_m` beside another in each coordinate.
    [[nodiscard]] virtual Configuration near(const Configuration& place, double radius_m) = 0;
};

}  // namespace downwash::planning
