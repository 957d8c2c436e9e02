#include "downwash/results/number_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "downwash/base/csv_reader.hpp"
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

std::string csv_text(const NumberTable& table) {
    constexpr std::size_t typical_number = 20;
    std::string text;
    text.reserve((table.rows() + 1) * table.columns.size() * typical_number);
    for (const std::string& name : table.names) {
        text += (text.empty() ? "" : ",") + name;
    }
    text += '\n';
    for (std::size_t row = 0; row < table.rows(); ++row) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const double number = table.columns[i][row];
            char digits[32];
            text.append(digits, std::isnan(number) ? digits : std::to_chars(digits, std::end(digits), number).ptr);
            text += i + 1 < table.columns.size() ? ',' : '\n';
        }
    }
    return text;
}

NumberTable read_number_table(std::string_view text, const std::string& file,
                              const std::vector<std::string>& required) {
    NumberTable table;
    LineErrors errors(file);
    CsvReader csv(text, errors, {max_table_numbers, max_columns});
    for (std::size_t i = 0; i < csv.names().size(); ++i) {
        if (!is_name(csv.names()[i])) {
            errors.add(csv.header_line(), csv.header_place(i),
                       "'" + excerpt(csv.names()[i]) + "' is no name of a column: expected letters, digits and '_'");
        }
    }
    table.names = csv.names();
    table.columns.resize(table.names.size());
    for (const std::string& name : required) {
        if (table.find(name) == nullptr) {
            errors.add(csv.header_line(), "there is no column '" + name + "'");
        }
    }
    errors.throw_any();
    std::vector<double> numbers(table.names.size());
    while (csv.next()) {
        if (table.rows() * table.columns.size() >= max_table_numbers) {
            errors.add(csv.line(),
                       "more than " + std::to_string(max_table_numbers) + " numbers, the most that a run writes");
            break;
        }
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = csv.cell(i).empty() ? std::numeric_limits<double>::quiet_NaN() : csv.number(i).value_or(0);
        }
        table.add_row(numbers);
        table.lines.back() = csv.line();
    }
    errors.throw_any();
    return table;
}

}  // namespace downwash
