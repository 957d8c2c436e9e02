#include "downwash/results/number_table.hpp"

#include <algorithm>
#include <limits>

#include "downwash/base/csv_lines.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/base/text.hpp"
#include "downwash/results/result_limits.hpp"

namespace downwash {
namespace {

constexpr std::size_t max_columns = 200;

bool is_name(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

void read_names(const CsvLines& lines, NumberTable& table, LineErrors& errors) {
    lines.for_each_cell([&](std::string_view name, std::size_t column) {
        if (std::find(table.names.begin(), table.names.end(), name) != table.names.end()) {
            errors.add(lines.number(), column, "the column '" + excerpt(name) + "' is there twice");
        }
        if (!is_name(name)) {
            errors.add(lines.number(), column,
                       "'" + excerpt(name) + "' is no name of a column: expected letters, digits and '_'");
        }
        if (table.names.size() == max_columns) {
            errors.add(lines.number(), column, "more than " + std::to_string(max_columns) + " columns");
            errors.throw_any();
        }
        table.names.emplace_back(name);
    });
    table.columns.resize(table.names.size());
}

void read_row(const CsvLines& lines, NumberTable& table, LineErrors& errors) {
    std::size_t cells = 0;
    table.lines.push_back(lines.number());
    lines.for_each_cell([&](std::string_view cell, std::size_t column) {
        if (cells < table.columns.size()) {
            const auto number = parse_number<double>(cell);
            if (!number && !cell.empty()) {
                errors.add(lines.number(), column, "'" + excerpt(cell) + "' is not a finite number");
            }
            table.columns[cells].push_back(number.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
        ++cells;
    });
    if (cells != table.columns.size()) {
        errors.add(lines.number(),
                   std::to_string(cells) + " cells under " + std::to_string(table.columns.size()) + " column names");
        errors.throw_any();
    }
}

}  // namespace

void NumberTable::add_row(const std::vector<double>& numbers) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        columns[i].push_back(numbers[i]);
    }
    lines.push_back(rows() + 1);  // below the line of names
}

const std::vector<double>* NumberTable::find(std::string_view name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

NumberTable read_number_table(std::string_view text, const std::string& file,
                              const std::vector<std::string>& required) {
    NumberTable table;
    LineErrors errors(file);
    CsvLines lines(text);
    if (!lines.next()) {
        errors.add(0, "the file is empty: expected a line of column names");
        errors.throw_any();
    }
    read_names(lines, table, errors);
    for (const std::string& name : required) {
        if (table.find(name) == nullptr) {
            errors.add(lines.number(), "there is no column '" + name + "'");
        }
    }
    errors.throw_any();
    while (lines.next()) {
        if (table.rows() * table.columns.size() >= max_table_numbers) {
            errors.add(lines.number(),
                       "more than " + std::to_string(max_table_numbers) + " numbers, the most that a run writes");
            break;
        }
        read_row(lines, table, errors);
    }
    errors.throw_any();
    return table;
}

}  // namespace downwash
