#pragma once

// Private to aeromap.

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// Along which level axes of a frame K stays the same.
struct SameAlong {
    bool x = false, lateral = false;
};

/// Where among the hubs in a box (world axes) K depends on less than three coordinates, as along a girder or under a
/// wide deck: every level part with straight edges that is over or under some disc either covers all discs, or ends
/// along the axis. Never true where K differs along the axis but for rounding; false where that is not seen.
[[nodiscard]] DOWNWASH_EXPORT SameAlong same_along(const DirectEffect& effect, const PlaneOfMotion& frame,
                                                   const BoundingBox& hubs);

}  // namespace downwash
