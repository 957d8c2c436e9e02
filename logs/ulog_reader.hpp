#pragma once

// Private to logs/.

#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_bytes.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// Reads a ULog of PX4 (docs.px4.io, "ULog File Format"; version 1). Times are those of its own clock, axes as they are
/// written: see finish().
/// @throws InputError with the byte at which the message begins that is wrong
[[nodiscard]] FlightLog read_ulog(LogBytes& bytes, const LogOptions& options);

}  // namespace downwash::logs
