#pragma once

// Private to aeromap.

#include "downwash/aeromap/direct_effect.hpp"

namespace downwash {

/// Nowhere among the hubs in a box (world axes) does K differ more than this from 1: each side counts as covered by a
/// flat surface somewhere from the least vertical gap on. Infinite when K comes from a given map.
[[nodiscard]] double max_change(const DirectEffect& effect, const Scene::Bounds& hubs);

/// Whether K differs so little from 1 among the hubs in a box that maps need not look closer: by 0.006 at most, or not
/// at all as the effects are disabled.
[[nodiscard]] bool is_quiet(const DirectEffect& effect, const Scene::Bounds& hubs);

/// How exact clearances are taken to be: the verdict on a cell or a box and the exact test must never disagree [m].
inline constexpr double clearance_slack_m = 1e-6;

}  // namespace downwash
