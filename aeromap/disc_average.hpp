#pragma once

// Private to aeromap.

#include <span>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprint.hpp"

namespace downwash {

/// The average over the disc of k(z(p)), z(p) the distance from p to the first surface on the side asked for.
/// @param primitives the footprints of the scene's first parts, Scene::primitive_count() of them
[[nodiscard]] double disc_average(const DiscQuery& query, std::span<const Footprint> primitives);

}  // namespace downwash
