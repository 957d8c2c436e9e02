#pragma once

#include <string>

#include "downwash/cli/output.hpp"
#include "downwash/comparison/log_comparison.hpp"
#include "downwash/logs/flight_log.hpp"

namespace downwash::cli {

/// A comparison and what it is of.
struct ShownComparison {
    std::string problem, plan;   ///< name of the problem, and the plan as the user gave it
    FlightLog log;               ///< its series may have gone
    double safety_margin_m = 0;  ///< of the problem
    LogComparison comparison;
};

/// What a log holds, for people and files, taken before its series go. @return one row for each of its series
[[nodiscard]] Json json_of(const FlightLog& log);

/// For programs. @param log json_of() the log
[[nodiscard]] Json json_of(const ShownComparison& shown, const Json& log);

/// For people: a verdict, then a table.
[[nodiscard]] std::string text_of(const ShownComparison& shown, const Json& log);

}  // namespace downwash::cli
