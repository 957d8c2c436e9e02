#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/reference_segment.hpp"

namespace downwash {

/// A timed reference: knots on control ticks, with a quintic between neighbouring knots.
struct DOWNWASH_EXPORT Plan {
    std::vector<ReferenceKnot> reference;      ///< the first at tick 0, ticks rising
    double tick_s = 0;                         ///< length of a control tick [s]
    std::span<const Axis> axes = planar_axes;  ///< what the numbers of its knots are; static

    [[nodiscard]] double duration_s() const {
        return reference.empty() ? 0 : static_cast<double>(reference.back().tick) * tick_s;
    }

    /// Where it begins. @pre there is a knot
    [[nodiscard]] Configuration first() const { return configuration_of(reference.front().point); }
    /// Where it ends. @pre there is a knot
    [[nodiscard]] Configuration last() const { return configuration_of(reference.back().point); }

    /// The reference at a tick: before the first knot that of the first, after the last knot that of the last.
    /// @pre there is a knot
    [[nodiscard]] ReferencePoint at(std::int64_t tick) const;
    /// The reference at a time, which need not be a tick [s]; at rest after the last knot. @pre there is a knot
    [[nodiscard]] ReferencePoint at_time(double t_s) const;

    /// The piece of the reference that ends at a knot other than the first.
    [[nodiscard]] ReferenceSegment segment_to(std::size_t knot) const;
    /// All pieces in their order, one fewer than knots.
    [[nodiscard]] std::vector<ReferenceSegment> segments() const;

    /// What is left from a tick on, as a plan whose tick 0 that is. @pre there is a knot
    [[nodiscard]] Plan rest_after(std::int64_t tick) const;
    /// The beginning of the plan, so many ticks long; a plan that is over earlier stays at its last point.
    /// @pre there is a knot
    [[nodiscard]] Plan beginning(std::int64_t ticks) const;
    /// The same reference with knots at most so many ticks apart. @pre there is a knot; most_ticks is at least 1
    [[nodiscard]] Plan divided(std::int64_t most_ticks) const;
    /// This plan and, from its last knot on, another one that begins there.
    [[nodiscard]] Plan followed_by(const Plan& next) const;
    /// This plan and a stay at its last point. @pre there is a knot
    [[nodiscard]] Plan held_for(std::int64_t ticks) const;
};

/// A plan may be this many control ticks long, not counting the last hover: an hour at 100 Hz.
inline constexpr std::int64_t max_plan_ticks = 360000;

}  // namespace downwash
