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
    double value = 0;  ///< where a rotor touches the wall; 0 if all measurements are too far away to tell
    /// Standard error of the value, at the decay as fitted. Empty with a single measurement, or if all are too far
    /// away.
    std::optional<double> standard_error;
    double rmse = 0;     ///< root mean square error over the measurements, over T or T R
    double largest = 0;  ///< the largest measured size
};

/// Both shares of some measurements.
struct WallShares {
    WallEffect effect;
    WallShare force, moment;
    std::size_t points = 0;
};

/// Fitted walls.
struct WallFit : WallShares {
    bool is_decay_at_bound = false;  ///< whether it lies at the end of the range of a problem file, 0.05 or 20
    /// Shares of each facility alone, with the decay of all; empty with one facility.
    std::vector<std::pair<std::string, WallShares>> by_facility;
};

/// Fits the wall effect by least squares: the decay to the moments, from 0.05 to 20 radii, both shares with that decay.
/// @throws InputError when fewer than two distances were measured, or the moments tell no decay
[[nodiscard]] DOWNWASH_EXPORT WallFit fit_walls(const std::vector<WallMeasurement>& measurements);

}  // namespace downwash
