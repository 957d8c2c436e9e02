#pragma once

// Private to aeromap.

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/map_view.hpp"

namespace downwash {

/// Upper bounds of |K - 1| by side.
struct SidedChange {
    double below, above;
};
/// Nowhere among the hubs in a box (world axes) does K differ more than this from 1: each side counts as covered by a
/// flat surface somewhere from the least vertical gap on. Where K comes from a given map: infinite, from above.
[[nodiscard]] SidedChange max_change(const DirectEffect& effect, const BoundingBox& hubs);

/// Whether K differs so little from 1 among the hubs in a box that maps need not look closer: by 0.006 at most, or not
/// at all as the effects are disabled.
[[nodiscard]] bool is_quiet(const DirectEffect& effect, const SidedChange& change);

/// A side that changes K by no more than this need not be told from the other one.
inline constexpr double quiet_side = 0.002;
[[nodiscard]] CellSides sides_of(const SidedChange& change);

/// How exact clearances are taken to be: the verdict on a cell or a box and the exact test must never disagree [m].
inline constexpr double clearance_slack_m = 1e-6;

}  // namespace downwash
