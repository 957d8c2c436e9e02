#pragma once

#include <optional>
#include <string>
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

/// Names of the signals that a column of a CSV can be declared to be: "t", "x", "qw", "rotor_1"...
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> csv_signal_names();

}  // namespace downwash
