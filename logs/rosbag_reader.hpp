#pragma once

// Private to logs/.

#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_bytes.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// Reads a bag of ROS 1 (wiki.ros.org, "Bags/Format/2.0") whose chunks are not compressed. Times are stamps of headers,
/// axes those of ROS, z up: see finish().
/// @throws InputError with the byte at which the record begins that is wrong
[[nodiscard]] FlightLog read_rosbag(LogBytes& bytes, const LogOptions& options);

}  // namespace downwash::logs
