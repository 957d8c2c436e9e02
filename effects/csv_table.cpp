#include "downwash/effects/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::size_t most_bytes = 16'000'000;
constexpr std::size_t most_rows = 100'000;
constexpr std::size_t most_columns = 32;
constexpr std::size_t most_faults = 20;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> cells_of(std::string_view line) {
    std::vector<std::string> cells;
    for (std::size_t start = 0; start <= line.size() && cells.size() <= most_columns;) {
        const std::size_t comma = std::min(line.find(',', start), line.size());
        cells.emplace_back(trimmed(line.substr(start, comma - start)));
        start = comma + 1;
    }
    return cells;
}

/// What keeps a line from being the header; empty when nothing does.
std::string header_fault(const std::vector<std::string>& columns) {
    if (columns.size() > most_columns) {
        return "more than " + std::to_string(most_columns) + " columns";
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].empty()) {
            return "column " + std::to_string(i + 1) + " has no name";
        }
        if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
            columns.begin() + static_cast<std::ptrdiff_t>(i)) {
            return "the column '" + excerpt(columns[i]) + "' stands there twice";
        }
    }
    return {};
}

void add_line(CsvTable& table, std::size_t number, std::string_view line, LineFaults& faults) {
    if (line.find('"') != std::string_view::npos) {
        faults.add(number, "holds a quotation mark; expected plain cells, separated by commas");
        return;
    }
    std::vector<std::string> cells = cells_of(line);
    if (table.columns.empty()) {
        if (const std::string fault = header_fault(cells); !fault.empty()) {
            faults.add(number, fault + "; expected the names of the columns, separated by commas");
            faults.throw_any();
        }
        table.columns = std::move(cells);
        table.header_line = number;
    } else if (cells.size() != table.columns.size()) {
        faults.add(number, "holds " + std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells") +
                               "; expected " + std::to_string(table.columns.size()) + ", one for each column of line " +
                               std::to_string(table.header_line));
    } else {
        table.rows.push_back({number, std::move(cells)});
    }
}

}  // namespace

void LineFaults::add(std::size_t line, const std::string& message) {
    if (faults_.size() < most_faults) {
        faults_.push_back({"", file_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + message});
    }
}

void LineFaults::throw_any() const {
    if (!faults_.empty()) {
        throw InputError(faults_);
    }
}

std::optional<std::size_t> CsvTable::find(std::string_view column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    return found == columns.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - columns.begin()));
}

std::string read_csv_text(const std::filesystem::path& file) {
    LineFaults faults{file.string()};
    std::string text;
    try {
        text = read_file(file, most_bytes + 1);
    } catch (const FileError& error) {
        faults.add(0, error.what());
    }
    if (text.size() > most_bytes) {
        faults.add(0, "has more than " + std::to_string(most_bytes / 1'000'000) + " MB; expected a short table");
    }
    faults.throw_any();
    return text;
}

CsvTable parse_csv(std::string_view text, LineFaults& faults) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    CsvTable table;
    std::size_t number = 0;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        const std::string_view line = trimmed(text.substr(start, end - start));
        start = end + 1;
        ++number;
        if (line.empty() || line.front() == '#') {
            continue;
        }
        if (table.rows.size() == most_rows) {
            faults.add(number,
                       "is row " + std::to_string(most_rows + 1) + "; expected at most " + std::to_string(most_rows));
            break;
        }
        add_line(table, number, line, faults);
    }
    if (table.columns.empty()) {
        faults.add(0, "holds no table; expected a line with the names of the columns, then rows");
        faults.throw_any();
    }
    return table;
}

std::optional<double> number_in(const CsvTable& table, const CsvTable::Row& row, std::size_t column, double low,
                                double high, LineFaults& faults) {
    const std::string& cell = row.cells[column];
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc() && end == cell.data() + cell.size() && value >= low && value <= high) {
        return value;
    }
    faults.add(row.line, table.columns[column] + " is '" + excerpt(cell) + "'; expected a number from " + to_text(low) +
                             " to " + to_text(high));
    return std::nullopt;
}

}  // namespace downwash
