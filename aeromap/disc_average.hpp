#pragma once

// Private to aeromap.

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprints.hpp"

namespace downwash {

/// The average over the disc of k(z(p)), z(p) the distance from p to the first surface on the side asked for.
/// @param footprints of the query's scene
[[nodiscard]] double disc_average(const DiscQuery& query, const Footprints& footprints);

}  // namespace downwash
