#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/judge/plan_judge.hpp"

namespace downwash::judge {

/// How the clearance of a flight develops: the least one [m] in each step of time.
using ClearanceTrace = std::vector<float>;

/// @param step_s length of a step, > 0
[[nodiscard]] DOWNWASH_EXPORT ClearanceTrace clearance_trace(const JudgedFlight& flight, double step_s);

/// Quantiles of the clearance [m] over many flights, for each step of time.
struct ClearanceFan {
    double step_s = 0;  ///< entry i is the least clearance from i to i + 1 steps after the start
    std::vector<double> minimum, p01, p10, p50;
};

/// A flight that has ended keeps the clearance at which it ended, so that the fan is always over all flights.
/// @param traces of steps of that length; none is empty
[[nodiscard]] DOWNWASH_EXPORT ClearanceFan clearance_fan(const std::vector<ClearanceTrace>& traces, double step_s);

}  // namespace downwash::judge
