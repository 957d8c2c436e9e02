#pragma once

// Private to logs/.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/logs/column_names.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// A column of a table that holds a signal.
struct SignalColumn {
    std::size_t column = 0;
    std::string_view written;               ///< a name by which the column was found; empty: the user declared it
    Dimension dimension = Dimension::none;  ///< that the unit in its name has; none: it names no unit of this signal
    double factor = 1;                      ///< to SI units, where it names one
};

/// What a table is, if ulog2csv made it of a topic of PX4.
enum class UlogTopic : std::uint8_t { none, local_position, odometry, setpoint, other };

/// Which columns hold the signals of a log: those that a user declares, or those with a name that programs use.
class CsvColumns {
 public:
    /// @param names of the columns, must outlive this
    /// @param file its name tells the topic of a table of ulog2csv whose columns do not
    CsvColumns(const std::vector<std::string>& names, std::span<const std::pair<std::string, std::string>> declared,
               const std::string& file);

    /// The column of a signal; empty if there is none.
    [[nodiscard]] std::optional<SignalColumn> find(std::string_view name) const;
    /// The columns of numbered signals, rotor_1, rotor_2... until one is missing.
    [[nodiscard]] std::vector<SignalColumn> find_numbered(std::string_view beginning) const;
    /// The axes that the names show; empty if they show none.
    [[nodiscard]] std::optional<LogAxes> axes() const;
    /// The topic of PX4 that the table is of. Its columns decide: it has `timestamp`, and those that only this topic
    /// has.
    [[nodiscard]] UlogTopic topic() const noexcept { return topic_; }
    /// Whether only the name of the file says so.
    [[nodiscard]] bool is_topic_by_name() const noexcept { return is_topic_by_name_; }
    /// Whether the names are those of a trajectory.csv of ours.
    [[nodiscard]] bool is_own() const;

 private:
    [[nodiscard]] std::optional<std::size_t> column_named(std::string_view name) const;
    [[nodiscard]] bool has(std::string_view name) const { return column_named(name).has_value(); }
    [[nodiscard]] SignalColumn column_of(std::string_view signal, std::size_t column, std::string_view written) const;
    [[nodiscard]] UlogTopic topic_by_columns() const;
    /// x, y and z by the names of directions, such as north, east and down.
    [[nodiscard]] std::optional<SignalColumn> find_direction(std::string_view signal) const;
    /// Whether there are north and east, and either down or up.
    [[nodiscard]] bool has_directions(LogAxes axes) const;

    const std::vector<std::string>& names_;
    std::vector<ColumnName> plain_;
    std::span<const std::pair<std::string, std::string>> declared_;
    UlogTopic topic_ = UlogTopic::none;
    bool is_topic_by_name_ = false;
};

/// Whether a name is that of a signal that a column can hold.
[[nodiscard]] bool is_csv_signal(std::string_view name);

}  // namespace downwash::logs
