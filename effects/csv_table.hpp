#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/line_errors.hpp"

namespace downwash {

/// Comma separated text: empty lines and lines that begin with `#` are left out, the first line left names the columns,
/// the others hold as many cells each. No quotes; spaces around cells do not count.
struct CsvTable {
    struct Row {
        std::size_t line;
        std::vector<std::string> cells;
    };
    std::vector<std::string> columns;  ///< distinct, none empty
    std::vector<Row> rows;
    std::size_t header_line = 0;

    [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;
};

/// The text of a regular file. @throws InputError when it cannot be read or has more than 16 MB
[[nodiscard]] std::string read_csv_text(const std::filesystem::path& file);

/// @throws InputError for text that is no table, through `errors`
[[nodiscard]] CsvTable parse_csv(std::string_view text, LineErrors& errors);

/// A number in [low, high]; an error of the row's line when the cell holds none.
[[nodiscard]] std::optional<double> number_in(const CsvTable& table, const CsvTable::Row& row, std::size_t column,
                                              double low, double high, LineErrors& errors);

}  // namespace downwash
