#pragma once

// Private to aeromap.

#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprint.hpp"

namespace downwash {

/// The average over the disc of k(z(p)), z(p) the distance from p to the first surface on the side asked for.
/// @param footprints of the query's scene
[[nodiscard]] double disc_average(const DiscQuery& query, const Footprints& footprints);

// What it uses where that is sooner.

/// disc_average over so many parts that finding every outline's crossing with every other would take too long: a fixed
/// number of parallel chords, each cut where a part begins or ends, with the first surface along every piece. The
/// chords run across most edges, so that the sum over them converges with the square of their number. Takes a time that
/// grows with the parts' number alone. Error: below 5e-3 where K differs by at most 1
/// over the disc, and that many times as much where it differs by more, as under a max_factor above 2.
/// @param background_m gap of what lies behind all parts; infinite for nothing
[[nodiscard]] double chord_sum(const DiscQuery& query, double background_m, std::span<const std::size_t> parts,
                               std::pmr::memory_resource* memory);

/// One plane face over or under the whole disc, not level: its gap is that over the hub plus a slope times the distance
/// from the hub along one direction.
struct PlaneCover {
    double gap_m;        ///< gap at the hub
    double gap_range_m;  ///< by how much it differs from that at the disc's rim, at most

    [[nodiscard]] double farthest_m() const noexcept { return gap_m + gap_range_m; }
};

/// The face of a part that covers the whole disc, if it is one plane face and lies wholly on the query's side.
[[nodiscard]] std::optional<PlaneCover> plane_cover(const DiscQuery& query, const Footprint& footprint);

/// The average of k over a disc that sees nothing but this, to rounding where k is smooth: over chords of equal gap it
/// is an integral over one variable.
[[nodiscard]] double plane_average(const DiscQuery& query, const PlaneCover& cover);

}  // namespace downwash
