#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/measurements.hpp"

namespace downwash {

/// How far the law of tilt (tilted_change in sided_factor.hpp) is from measurements. Errors are K minus thrust ratio.
struct TiltScore {
    double tilt_loss = 0;
    bool is_at_bound = false;  ///< fitted, and at the end of the range of a problem file, 0 or 100
    double rmse = 0, max_error = 0;
    std::size_t points = 0;
};

/// The tilt loss fitted to measurements of tilted rotors.
struct TiltFit {
    TiltScore fitted;
    /// Standard error of the loss; empty with a single measurement or at a bound.
    std::optional<double> standard_error;
    TiltScore as_level;  ///< score with the loss 0
    /// How well, for each source with tilted rotors, the loss fitted to all others predicts it; empty with one source.
    std::vector<std::pair<std::string, TiltScore>> left_out;
};

/// Fits the tilt loss by least squares, from 0 to 100. K of a level rotor is interpolated between the measurements
/// without tilt, which must be of the same bench; where several are at one distance their mean counts.
/// @throws InputError when fewer than two distances were measured without tilt, nothing with tilt, a tilted rotor
/// nearer or farther than all level ones, several surfaces, or no effect
[[nodiscard]] DOWNWASH_EXPORT TiltFit fit_tilt_loss(const Measurements& measurements);

}  // namespace downwash
