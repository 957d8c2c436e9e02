#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/wall_effect.hpp"
#include "downwash/effects/wall_measurements.hpp"

namespace downwash {

/// A share of WallEffect beside measurements of it.
struct WallShare {
    double value = 0;                      ///< where a rotor touches the wall
    std::optional<double> standard_error;  ///< of that, at the decay as fitted; empty with a single measurement
    double rmse = 0;                       ///< of the measurements, over T or T R
    double largest = 0;                    ///< the largest measured size
};

/// Both shares of some measurements.
struct WallShares {
    WallEffect effect;
    WallShare force, moment;
    std::size_t points = 0;
};

/// Fitted walls.
struct WallFit : WallShares {
    /// The same of each facility alone, with the decay of all; empty with one facility.
    std::vector<std::pair<std::string, WallShares>> by_facility;
};

/// Fits the wall effect by least squares: the decay to the moments, both shares with that decay.
/// @throws InputError when fewer than two distances were measured
[[nodiscard]] DOWNWASH_EXPORT WallFit fit_walls(const std::vector<WallMeasurement>& measurements);

}  // namespace downwash
