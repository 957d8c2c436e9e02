#pragma once

// Private to aeromap.

#include <optional>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprint.hpp"

namespace downwash {

/// One plane face over or under the whole disc, not level: its gap is that over the hub plus a slope times the distance
/// from the hub along one direction.
struct PlaneCover {
    double gap_m;        ///< at the hub
    double gap_range_m;  ///< by how much it differs from that at the disc's rim, at most

    [[nodiscard]] double farthest_m() const noexcept { return gap_m + gap_range_m; }
};

/// The face of a part that covers the whole disc, if it is one plane face and lies wholly on the query's side.
[[nodiscard]] std::optional<PlaneCover> plane_cover(const DiscQuery& query, const Footprint& footprint);

/// The average of k over a disc that sees nothing but this, to rounding where k is smooth: over chords of equal gap it
/// is an integral over one variable.
[[nodiscard]] double plane_average(const DiscQuery& query, const PlaneCover& cover);

}  // namespace downwash
