#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/search/family.hpp"

namespace downwash {

/// Where a vehicle that follows a plan can break off and hover.
template <class Family>
struct SafeStopsOf {
    using Configuration = typename Family::Configuration;

    struct Moment {
        std::int64_t tick = 0;
        std::optional<Configuration>
            rest;               ///< where the reference is after braking; empty: no stop is known to be safe
        double duration_s = 0;  ///< until it is at rest
    };
    std::vector<Moment> moments;  ///< moments at each knot, and at most half a second apart
    double share_without = 0;     ///< share of the plan's time, without the last hover, that has no safe stop
};
using SafeStops = SafeStopsOf<planning::Plane>;

/// Whether a plan has no safe stop for clearly more of its time than another one: by a hundredth of it.
template <class Family>
[[nodiscard]] bool is_clearly_worse(const SafeStopsOf<Family>& plan, const SafeStopsOf<Family>& other) {
    constexpr double clearly = 0.01;
    return plan.share_without > other.share_without + clearly;
}

}  // namespace downwash
