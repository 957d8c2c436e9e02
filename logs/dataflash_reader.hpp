#pragma once

// Private to logs/.

#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_bytes.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// Reads a binary log of ArduPilot (libraries/AP_Logger/LogStructure.h). Times are those of its own clock, axes as they
/// are written: see finish().
/// @throws InputError with the byte at which the message begins that is wrong
[[nodiscard]] FlightLog read_dataflash(LogBytes& bytes, const LogOptions& options);

}  // namespace downwash::logs
