#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/reference_segment.hpp"

namespace downwash {

/// A timed reference.
struct Plan {
    std::vector<ReferenceKnot> reference;      ///< the first at tick 0
    double tick_s = 0;                         ///< length of a control tick
    std::span<const Axis> axes = planar_axes;  ///< of its knots, static

    [[nodiscard]] double duration_s() const {
        return reference.empty() ? 0 : static_cast<double>(reference.back().tick) * tick_s;
    }

    /// Where it begins. @pre there is a knot
    [[nodiscard]] Configuration first() const { return configuration_of(reference.front().point); }
    /// Where it ends. @pre there is a knot
    [[nodiscard]] Configuration last() const { return configuration_of(reference.back().point); }
};

/// A plan may be this many control ticks long, not counting the last hover: an hour at 100 Hz.
inline constexpr std::int64_t max_plan_ticks = 360000;

}  // namespace downwash
