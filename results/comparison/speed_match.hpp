#pragma once

// Private to results/comparison/.

#include <optional>
#include <vector>

#include "downwash/comparison/compared_plan.hpp"
#include "downwash/logs/flight_log.hpp"

namespace downwash {

/// A time of a log at which a plan may begin.
struct SpeedMatch {
    double offset_s = 0;
    double correlation = 0;  ///< 2 sum(a b) / (sum(a a) + sum(b b)) of the speeds while the plan lasts; 1: the same
};

struct SpeedMatches {
    double step_s = 0;  ///< between times that were tried
    /// The best ones that are apart from each other, five at most; one at least. Then the best one that is half a plan
    /// or more from the first, as of a second flight in the log, if there is one.
    std::vector<SpeedMatch> best;
};

/// Where the horizontal and the vertical speed of a log are those of a plan's flight. Vertical speeds count without
/// their sign where the log's axes are guessed. Frames do not matter.
/// @throws InputError if the plan does not move
[[nodiscard]] SpeedMatches match_speeds(const FlightLog& log, const PlannedFlight& planned);

/// The yaw between a log's attitude and the reference while the plan lasts, on average [rad]; empty without an
/// attitude.
[[nodiscard]] std::optional<double> yaw_by_attitude(const FlightLog& log, const PlannedFlight& planned, double offset_s,
                                                    double rate);

}  // namespace downwash
