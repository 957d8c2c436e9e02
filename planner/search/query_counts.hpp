#pragma once

#include <cstdint>

#include "downwash/search/search_record.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {

/// Counts of what OMPL's planners asked.
struct QueryCounts {
    std::uint64_t states = 0;
    std::uint64_t rejected_collision = 0;  ///< states and motions
    std::uint64_t rejected_bounds = 0;
    std::uint64_t rejected_arm_limits = 0;
    StoppedBy stopped_by;  ///< states and motions

    [[nodiscard]] std::uint64_t rejected() const noexcept {
        return rejected_collision + rejected_bounds + rejected_arm_limits;
    }
    /// Counts a query and says whether it found nothing wrong.
    bool note(Rejection rejection) noexcept;
};

}  // namespace downwash::planning
