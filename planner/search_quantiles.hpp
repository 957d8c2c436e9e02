#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/simulation/world_parameters.hpp"

namespace downwash::planning {

/// Quantiles of a world of a search: first worlds in which dangers come early (DangerQuantiles), then points spread
/// evenly (Kronecker's sequence).
/// @param dangers of each parameter that the world draws
/// @param first_apart from it on parameters have a sequence of their own: neither depends on the other
/// @param number of the world, from 1
[[nodiscard]] std::vector<double> search_quantiles(std::span<const DangerQuantiles> dangers, std::size_t first_apart,
                                                   std::uint64_t number);

}  // namespace downwash::planning
