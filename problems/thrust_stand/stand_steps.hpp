#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "downwash/thrust_stand/stand_log.hpp"

namespace downwash::thrust_stand {

/// Rows [first, last) of equal throttle, one after the other.
struct Stretch {
    std::size_t first = 0, last = 0;
};

/// The stretches of a log with time and throttle; of others every row by itself.
[[nodiscard]] std::vector<Stretch> stretches_of(const StandLog& log);

/// The means over the later half of each stretch, in which rotors no longer change their speed.
[[nodiscard]] std::vector<StandRow> measurements_of(const StandLog& log, const std::vector<Stretch>& stretches);

/// The time constant behind one step of the throttle.
struct StepLag {
    double time_constant_s = 0;
    bool is_rise = true;
};

/// The lags behind all steps of a log that are large and sampled enough: a first-order way from one steady value to
/// the next, by least squares, from when the throttle changes. Values are squares of the speed where there is one, else
/// thrusts. Empty for a log without time or throttle.
[[nodiscard]] std::vector<StepLag> lags_of(const StandLog& log, const std::vector<Stretch>& stretches);

/// Whether lags_of() looks at speeds.
[[nodiscard]] bool has_speed(const StandLog& log);

}  // namespace downwash::thrust_stand
