#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/logs/flight_log.hpp"

namespace downwash {

/// What a user says of a log. What is left out follows from the format, or is guessed and told in FlightLog::remarks.
struct LogOptions {
    std::optional<LogFormat> format;  ///< empty: that which the first bytes show
    std::optional<LogAxes> axes;
    /// Whether a log that ends within a message, as one does after a loss of power, is read up to its last whole one.
    bool allows_truncation = false;
    // Of CSV:
    std::optional<double> time_unit_s;      ///< what a 1 in the column of times is [s], > 0
    std::optional<bool> angles_in_degrees;  ///< joints and attitude as roll, pitch and yaw
    /// Signals and their columns: {"x", "pos_east"}. Signals are those of csv_signal_names().
    std::vector<std::pair<std::string, std::string>> columns;
    // Of bags:
    std::vector<std::string> topics;  ///< to be read; empty: the first of each type that says something
};

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

/// Names of the signals that a column of a CSV can be declared to be: "t", "x", "qw", "rotor_1"...
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> csv_signal_names();

}  // namespace downwash
