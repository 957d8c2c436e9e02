#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/line_errors.hpp"

namespace downwash {

/// The position of a column; empty if there is none of that name.
[[nodiscard]] std::optional<std::size_t> index_of(const std::vector<std::string>& columns, std::string_view column);

/// Comma-separated text. Empty lines and lines that begin with `#` are skipped. The first other line names the columns,
/// and the following ones have as many cells each. Quoting is not supported. Spaces around cells are ignored.
struct CsvTable {
    struct Row {
        std::size_t line;
        std::vector<std::string> cells;
    };
    std::vector<std::string> columns;  ///< distinct, none empty
    std::vector<Row> rows;
    std::size_t header_line = 0;

    [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const { return index_of(columns, column); }
};

/// The text of a regular file. @throws InputError if it cannot be read or has more than 16 MiB
[[nodiscard]] std::string read_csv_text(const std::filesystem::path& file);

/// @throws InputError if the text is not a table, through `errors`
[[nodiscard]] CsvTable parse_csv(std::string_view text, LineErrors& errors);

/// The number in a cell. If it is not a number in [low, high], returns nothing and adds an error for the row's line.
[[nodiscard]] std::optional<double> number_in(const CsvTable& table, const CsvTable::Row& row, std::size_t column,
                                              double low, double high, LineErrors& errors);

}  // namespace downwash
