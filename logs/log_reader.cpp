#include "downwash/logs/log_reader.hpp"

#include <algorithm>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/logs/csv_log.hpp"
#include "downwash/logs/dataflash_reader.hpp"
#include "downwash/logs/log_jumps.hpp"
#include "downwash/logs/rosbag_reader.hpp"
#include "downwash/logs/ulog_reader.hpp"

namespace downwash {
namespace {

/// Takes the series that a log lacks from another table of the same flight.
void take_missing(FlightLog& log, FlightLog&& other) {
    if (log.position_m.empty() && !other.position_m.empty()) {
        log.recorded_axes = other.recorded_axes;
        log.axes_source = other.axes_source;
    }
    if (other.axes_source == AxesSource::format && log.axes_source == AxesSource::format &&
        other.recorded_axes != log.recorded_axes) {
        turn_over(other);
    }
    log.jumps.insert(log.jumps.end(), other.jumps.begin(), other.jumps.end());
    if (log.rotor_commands.empty()) {
        log.rotor_unit = other.rotor_unit;
    }
    for (const NamedSeries& each : named_series) {
        if ((log.*each.series).empty()) {
            log.*each.series = std::move(other.*each.series);
        }
    }
    log.files.insert(log.files.end(), other.files.begin(), other.files.end());
    log.remarks.insert(log.remarks.end(), other.remarks.begin(), other.remarks.end());
}

/// Checks that every column that a user declares is in some table.
void check_columns(const std::vector<std::string>& names, const std::string& file, const LogOptions& options) {
    for (const auto& [signal, column] : options.columns) {
        if (std::ranges::find(names, column) == names.end()) {
            std::string message = file;
            message.append(": there is no column '").append(excerpt(column)).append("', which is said to be ");
            message.append(signal).append("; columns are ").append(excerpt(joined(names, ", ")));
            throw_input_error(std::move(message));
        }
    }
}

FlightLog read_tables(const std::vector<std::filesystem::path>& files, const LogOptions& options) {
    FlightLog log;
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files) {
        const std::string text = naming(file, [&] { return read_whole_file(file, logs::max_csv_bytes); });
        logs::CsvFlight table = logs::read_csv_log(text, file.string(), options);
        names.insert(names.end(), table.names.begin(), table.names.end());
        if (log.files.empty()) {
            log = std::move(table.log);
        } else {
            take_missing(log, std::move(table.log));
        }
    }
    check_columns(names, files.front().string(), options);
    return log;
}

/// What to do with a file that is no log that can be read; empty: nothing is known.
std::string_view remedy_for(std::string_view first_bytes) {
    using namespace std::string_view_literals;
    constexpr std::string_view of_ros_2 =
        "is a bag of ROS 2: `rosbags-convert` (Python's rosbags) makes a bag of ROS 1 of its folder, compressed or not";
    if (first_bytes.starts_with("SQLite format 3\0"sv) || first_bytes.starts_with("\x89MCAP0"sv)) {
        return of_ros_2;
    }
    if (first_bytes.starts_with("\x28\xB5\x2F\xFD"sv)) {
        return "is compressed by zstd: `unzstd` unpacks it; a bag of ROS 2 becomes one of ROS 1 by `rosbags-convert`";
    }
    if (first_bytes.starts_with("BZh"sv) || first_bytes.starts_with("\x1F\x8B"sv) ||
        first_bytes.starts_with("PK\x03\x04"sv) || first_bytes.starts_with("\x04\x22\x4D\x18"sv)) {
        return "is compressed: unpack it first";
    }
    return {};
}

FlightLog read_binary(logs::LogBytes& bytes, LogFormat format, const LogOptions& options) {
    return format == LogFormat::ulog        ? logs::read_ulog(bytes, options)
           : format == LogFormat::dataflash ? logs::read_dataflash(bytes, options)
                                            : logs::read_rosbag(bytes, options);
}

FlightLog finished(FlightLog log) {
    if (log.position_m.empty()) {
        throw_input_error(log.files.front() + ": there is no position in this log" +
                          (log.remarks.empty() ? "" : "; " + joined(log.remarks, "; ")));
    }
    finish(log);
    logs::find_jumps(log);
    return log;
}

}  // namespace

LogFormat log_format_of(std::string_view first_bytes) noexcept {
    using namespace std::string_view_literals;
    return first_bytes.starts_with("ULog\x01\x12\x35"sv) ? LogFormat::ulog
           : first_bytes.starts_with("\xA3\x95"sv)       ? LogFormat::dataflash
           : first_bytes.starts_with("#ROSBAG "sv)       ? LogFormat::rosbag
                                                         : LogFormat::csv;
}

FlightLog read_flight_log(const std::vector<std::filesystem::path>& files, const LogOptions& options) {
    const auto format_of = [&options](const std::filesystem::path& file) {
        constexpr std::size_t enough = 16;
        const std::string bytes = naming(file, [&] { return read_file(file, enough); });
        if (const std::string_view remedy = remedy_for(bytes); !remedy.empty()) {
            throw_input_error(file.string() + " " + std::string(remedy));
        }
        return options.format.value_or(log_format_of(bytes));
    };
    if (files.size() > 1) {
        for (const std::filesystem::path& file : files) {
            if (const LogFormat format = format_of(file); format != LogFormat::csv) {
                throw_input_error(file.string() + " is a " + std::string(name_of(format)) +
                                  " log: expected one of these alone, or several tables of one flight");
            }
        }
    }
    const LogFormat format = format_of(files.front());
    if (format == LogFormat::csv) {
        return finished(read_tables(files, options));
    }
    logs::LogBytes bytes(files.front());
    return finished(read_binary(bytes, format, options));
}

FlightLog read_flight_log(std::string_view bytes, const std::string& name, const LogOptions& options) {
    const LogFormat format = options.format.value_or(log_format_of(bytes));
    if (format != LogFormat::csv) {
        logs::LogBytes log(bytes, name);
        return finished(read_binary(log, format, options));
    }
    logs::CsvFlight table = logs::read_csv_log(bytes, name, options);
    check_columns(table.names, name, options);
    return finished(std::move(table.log));
}

}  // namespace downwash
