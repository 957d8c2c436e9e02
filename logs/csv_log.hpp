#pragma once

// Private to logs/.

#include <string>
#include <string_view>
#include <vector>

#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// Larger tables are not read: the text stands in memory.
inline constexpr std::size_t max_csv_bytes = std::size_t{700} << 20U;

/// What a table says of a flight.
struct CsvFlight {
    FlightLog log;                   ///< with times of its own clock and axes as they are written: see finish()
    std::vector<std::string> names;  ///< of its columns
};

/// Reads a table of a flight.
/// @param file its name, for messages and for what ulog2csv tells by it
/// @throws InputError with line and column
[[nodiscard]] CsvFlight read_csv_log(std::string_view text, const std::string& file, const LogOptions& options);

}  // namespace downwash::logs
