#include "downwash/base/csv_remedies.hpp"

#include <algorithm>

#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

std::string count_text(std::size_t count, const char* thing) {
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string separator_text(char separator) {
    return separator == '\t' ? "tabs" : separator == ' ' ? "blanks" : "'" + std::string(1, separator) + "'";
}

/// What to do about a column that is called like `name` but for a unit or blanks.
std::string name_remedy(const std::vector<std::string>& written_names, std::string_view name) {
    for (const std::string& written : written_names) {
        const std::size_t unit = std::min(written.find_first_of("[("), written.size());
        std::string plain(trimmed(std::string_view(written).substr(0, unit)));
        std::replace_if(
            plain.begin(), plain.end(), [](char c) { return c == ' ' || c == '-' || c == '/' || c == '.'; }, '_');
        if (is_same_word(plain, name)) {
            return "; write '" + excerpt(written) + "' as " + std::string(name) +
                   (written.find('%', unit) != std::string::npos ? ", and divide percent by 100" : "");
        }
    }
    return {};
}

}  // namespace

std::string names_remedy(const std::vector<std::string>& written, const std::vector<std::string_view>& missing,
                         const CsvRest& rest) {
    std::string remedy;
    for (const std::string_view name : missing) {
        remedy += name_remedy(written, name);
    }
    if (!remedy.empty()) {
        return remedy;
    }
    if (std::any_of(written.begin(), written.end(), [](const auto& n) { return n.find('|') != std::string::npos; })) {
        return "; separate columns by ';', tabs or ',', not by '|'";
    }
    std::string_view below = rest.text;
    for (std::size_t line = rest.line; line < rest.line + 5 && !below.empty(); ++line) {
        const std::string_view text = below.substr(0, below.find(rest.line_end));
        if (std::any_of(missing.begin(), missing.end(),
                        [text](std::string_view name) { return text.find(name) != std::string_view::npos; })) {
            return "; the names seem to stand in line " + std::to_string(line) + ": begin the lines above with #";
        }
        below.remove_prefix(std::min(text.size() + 1, below.size()));
    }
    return {};
}

std::string sign_remedy(std::string_view cell, char decimal_sign, std::size_t decimal_line) {
    const char other = decimal_sign == '.' ? ',' : '.';
    if (cell.find(other) == std::string_view::npos || !decimal_number(cell, other)) {
        return {};
    }
    if (decimal_line == 0) {
        std::string as_decimal(cell);
        std::replace(as_decimal.begin(), as_decimal.end(), ',', '.');
        std::string as_thousands(cell);
        std::erase(as_thousands, ',');
        return ", which may mean " + excerpt(as_decimal) + " or " + excerpt(as_thousands) +
               ": expected one of these; add a zero to its decimals, or leave out what stands between thousands";
    }
    return std::string(other == ',' ? ", with a comma" : ", with a point") + ", but a number in line " +
           std::to_string(decimal_line) + " has a decimal " + (other == ',' ? "point" : "comma") +
           ": expected one decimal sign in the whole file, and none between thousands";
}

LengthError length_error(const std::vector<std::string_view>& cells, std::size_t count, const CsvShape& shape) {
    const std::string message = "holds " + count_text(count, "cell") + ": expected " + std::to_string(shape.columns) +
                                ", one for each column of line " + std::to_string(shape.header_line);
    const auto are_digits = [](std::string_view cell) {
        return cell.find_first_not_of("+-0123456789") == std::string_view::npos;
    };
    if (shape.separator == ',' && count > shape.columns && std::all_of(cells.begin(), cells.end(), are_digits)) {
        return {message + "; if its numbers have decimal commas, separate the columns by ';' or quote the numbers",
                true};
    }
    if (count == shape.columns + 1 && shape.is_first_row && shape.separator == ' ' && cells.front() == "1") {
        return {
            message + "; if the first one is the name of a row, as R writes it, leave those out (row.names = FALSE)",
            true};
    }
    const std::string_view first = cells.front();
    const char other = separator_of(first);
    std::string_view rest = first;
    const bool is_other = other == ' ' ? shape.separator != ' ' && is_number(take_word(rest)) && !rest.empty()
                                       : other != shape.separator && first.find(other) != std::string_view::npos;
    if (count == 1 && is_other) {
        return {message + "; separate it as the names, by " + separator_text(shape.separator), true};
    }
    return {message, false};
}

}  // namespace downwash
