#pragma once

// Private to logs/.

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "downwash/logs/flight_log.hpp"

namespace downwash::logs {

/// A series that a log may hold, and what it would be.
struct CandidateSeries {
    LogSeries FlightLog::*what = nullptr;
    std::size_t rank = 0;  ///< the least one of those with rows is taken
    LogSeries series;
    RotorUnit rotor_unit = RotorUnit::newton;  ///< of rotor commands
    std::size_t late_rows = 0;                 ///< not later than those before
    std::size_t invalid_rows = 0;              ///< that the autopilot itself does not trust
};

/// Moves the best candidate of each kind into a log, and remarks on what it leaves out of them.
void choose(std::deque<CandidateSeries>& candidates, FlightLog& log);

}  // namespace downwash::logs
