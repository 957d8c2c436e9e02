#pragma once

// Private to logs/.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/line_errors.hpp"
#include "downwash/logs/log_options.hpp"

namespace downwash::logs {

/// A column of a table that holds a signal.
struct SignalColumn {
    std::size_t column = 0;
    std::string_view written;  ///< a name by which the column was found; empty: the user declared it
};

/// Which columns hold the signals of a log: those that a user declares, or those with a name that programs use.
class CsvColumns {
 public:
    /// @param names of the columns, must outlive this   @param file its name tells what ulog2csv wrote
    CsvColumns(const std::vector<std::string>& names, std::span<const std::pair<std::string, std::string>> declared,
               const std::string& file);

    /// The column of a signal; empty if there is none.
    [[nodiscard]] std::optional<SignalColumn> find(std::string_view name) const;
    /// The columns of numbered signals, rotor_1, rotor_2... until one is missing.
    [[nodiscard]] std::vector<SignalColumn> find_numbered(std::string_view beginning) const;
    /// The axes that the names show; empty if they show none.
    [[nodiscard]] std::optional<LogAxes> axes() const;
    /// Whether the table is a topic of PX4 as ulog2csv writes it, by the name of its file.
    [[nodiscard]] bool is_of_ulog() const noexcept { return is_of_ulog_; }
    /// Whether the names are those of a trajectory.csv of ours.
    [[nodiscard]] bool is_own() const;

 private:
    [[nodiscard]] std::optional<std::size_t> column_named(std::string_view name) const;

    const std::vector<std::string>& names_;
    std::span<const std::pair<std::string, std::string>> declared_;
    bool is_of_ulog_ = false, holds_setpoints_ = false;
};

/// Whether a name is that of a signal that a column can hold.
[[nodiscard]] bool is_csv_signal(std::string_view name);

}  // namespace downwash::logs
