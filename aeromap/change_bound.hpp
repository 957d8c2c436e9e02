#pragma once

// Private to aeromap.

#include "downwash/aeromap/direct_effect.hpp"

namespace downwash {

/// Nowhere among the hubs in a box (world axes) does K differ more than this from 1: each side counts as covered by a
/// flat surface somewhere from the least vertical gap on. Infinite when K comes from a given map.
[[nodiscard]] double largest_change(const DirectEffect& effect, const Scene::Bounds& hubs);

}  // namespace downwash
