#pragma once

// Private to aeromap.

#include <cstddef>
#include <memory_resource>
#include <span>

#include "downwash/aeromap/disc_query.hpp"

namespace downwash {

/// disc_average over so many parts that finding every outline's crossing with every other would take too long: a fixed
/// number of parallel chords, each cut where a part begins or ends, with the first surface along every piece. The
/// chords run across most edges, so that the sum over them converges with the square of their number. Takes a time that
/// grows with the parts' number alone. Error: below 5e-3 where K differs by at most 1
/// over the disc, and that many times as much where it differs by more, as under a max_factor above 2.
/// @param background_m gap of what lies behind all parts; infinite for nothing
[[nodiscard]] double chord_sum(const DiscQuery& query, double background_m, std::span<const std::size_t> parts,
                               std::pmr::memory_resource* memory);

}  // namespace downwash
