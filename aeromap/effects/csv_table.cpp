#include "downwash/effects/csv_table.hpp"

#include <algorithm>
#include <utility>

#include "downwash/base/csv_lines.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::size_t max_bytes = std::size_t{16} << 20U;
constexpr std::size_t max_rows = 100'000;
constexpr std::size_t max_columns = 32;

/// What keeps a line from being the header; empty when nothing does.
std::string header_error(const std::vector<std::string>& columns) {
    if (columns.size() > max_columns) {
        return "more than " + std::to_string(max_columns) + " columns";
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].empty()) {
            return "column " + std::to_string(i + 1) + " has no name";
        }
        if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
            columns.begin() + static_cast<std::ptrdiff_t>(i)) {
            return "the column '" + excerpt(columns[i]) + "' occurs twice";
        }
    }
    return {};
}

void add_line(CsvTable& table, const CsvLines& line, LineErrors& errors) {
    if (line.text().find('"') != std::string_view::npos) {
        errors.add(line.number(), "holds a quotation mark; expected plain cells, separated by commas");
        return;
    }
    std::vector<std::string> cells;
    line.for_each_cell([&cells](std::string_view cell, std::size_t) {
        if (cells.size() <= max_columns) {
            cells.emplace_back(cell);
        }
    });
    if (table.columns.empty()) {
        if (const std::string error = header_error(cells); !error.empty()) {
            errors.add(line.number(), error + "; expected the names of the columns, separated by commas");
            errors.throw_any();
        }
        table.columns = std::move(cells);
        table.header_line = line.number();
    } else if (cells.size() != table.columns.size()) {
        errors.add(line.number(), "holds " + std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells") +
                                      "; expected " + std::to_string(table.columns.size()) +
                                      ", one for each column of line " + std::to_string(table.header_line));
    } else {
        table.rows.push_back({line.number(), std::move(cells)});
    }
}

}  // namespace

std::optional<std::size_t> index_of(const std::vector<std::string>& columns, std::string_view column) {
    const auto found = std::find(columns.begin(), columns.end(), column);
    return found == columns.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - columns.begin()));
}

std::string read_csv_text(const std::filesystem::path& file) {
    try {
        return read_whole_file(file, max_bytes);
    } catch (const FileError& error) {
        throw_input_error(file.string() + ": " + error.what());
    }
}

CsvTable parse_csv(std::string_view text, LineErrors& errors) {
    CsvTable table;
    CsvLines line(text);
    while (line.next()) {
        if (line.is_comment()) {
            continue;
        }
        if (table.rows.size() == max_rows) {
            errors.add(line.number(),
                       "is row " + std::to_string(max_rows + 1) + "; expected at most " + std::to_string(max_rows));
            break;
        }
        add_line(table, line, errors);
    }
    if (table.columns.empty()) {
        errors.add(0, "holds no table; expected a line with the names of the columns, then rows");
        errors.throw_any();
    }
    return table;
}

std::optional<double> number_in(const CsvTable& table, const CsvTable::Row& row, std::size_t column, double low,
                                double high, LineErrors& errors) {
    const std::string& cell = row.cells[column];
    const std::optional<double> value = parse_number<double>(cell);
    if (value && *value >= low && *value <= high) {
        return value;
    }
    errors.add(row.line, table.columns[column] + " is '" + excerpt(cell) + "'; expected a number from " + to_text(low) +
                             " to " + to_text(high));
    return std::nullopt;
}

}  // namespace downwash
