#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash {

/// Reads a flight log. Several files are tables of one flight with the same clock, such as ulog2csv writes.
/// @throws InputError with the place of what is wrong: the byte of a binary log, the line and column of a table; also
/// if there is no position in it
[[nodiscard]] DOWNWASH_EXPORT FlightLog read_flight_log(const std::vector<std::filesystem::path>& files,
                                                        const LogOptions& options = {});

/// The same of bytes in memory. @param name of the file, for messages and for what ulog2csv tells by it
[[nodiscard]] DOWNWASH_EXPORT FlightLog read_flight_log(std::string_view bytes, const std::string& name,
                                                        const LogOptions& options = {});

/// The format that the first bytes of a file show; CSV if they show none.
[[nodiscard]] DOWNWASH_EXPORT LogFormat log_format_of(std::string_view first_bytes) noexcept;

}  // namespace downwash
