#include "downwash/base/csv_dialect.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::string_view typographic_minus = "\xE2\x88\x92";  // U+2212

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool are_digits(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

std::string_view without_sign(std::string_view text) {
    if (text.starts_with(typographic_minus)) {
        return text.substr(typographic_minus.size());
    }
    return text.starts_with('-') || text.starts_with('+') ? text.substr(1) : text;
}

/// "1.5" and "3" of "-1.5e3"; the exponent is empty if there is none.
struct NumberParts {
    std::string_view mantissa, exponent;
};

NumberParts parts_of(std::string_view number) {
    const std::string_view text = without_sign(number);
    const std::size_t e = std::min(text.find_first_of("eE"), text.size());
    return {text.substr(0, e), text.substr(std::min(e + 1, text.size()))};
}

}  // namespace

char line_end_of(std::string_view text) {
    bool is_begin = true;  // of a line
    bool is_comment = false;
    bool is_quoted = false;
    bool has_feed = false;
    bool has_return = false;
    for (const char c : text) {
        const bool is_end = c == '\n' || c == '\r';
        is_comment = !is_end && (is_comment || (c == '#' && is_begin && !is_quoted));
        is_quoted = is_quoted != (c == '"' && !is_comment);
        is_begin = is_end || (is_begin && (c == ' ' || c == '\t'));
        has_feed = has_feed || c == '\n';
        has_return = has_return || (c == '\r' && !is_quoted);
        if (c == '\n' && !is_quoted) {
            return '\n';
        }
    }
    return has_feed && !has_return ? '\n' : '\r';
}

char separator_of(std::string_view line) {
    std::string outside;  // what stands outside quotation marks, a letter for what stands inside
    bool is_quoted = false;
    for (const char c : trimmed(line)) {
        is_quoted = is_quoted != (c == '"');
        outside += is_quoted || c == '"' ? 'q' : c;
    }
    const auto has = [&outside](const char* text) { return outside.find(text) != std::string::npos; };
    if (has(";")) {
        return ';';
    }
    if (has("\t") && !has(",\t") && !has(", \t")) {
        return '\t';
    }
    return !has(",") && (has(" ") || has("\t")) ? ' ' : ',';
}

char decimal_sign_of(std::string_view cell) {
    const auto [mantissa, exponent] = parts_of(cell);
    const std::size_t last = mantissa.find_last_of(",.");
    if (last == std::string_view::npos || (!exponent.empty() && !are_digits(without_sign(exponent))) ||
        mantissa.find_first_not_of("0123456789,.") != std::string_view::npos) {
        return 0;
    }
    const char sign = mantissa[last];
    const std::size_t first = mantissa.find_first_of(",.");
    if (first != last) {
        return mantissa[first] == sign ? '\0' : sign;
    }
    const std::string_view whole = mantissa.substr(0, last);
    const std::string_view decimals = mantissa.substr(last + 1);
    const bool may_be_thousands = are_digits(whole) && whole.size() <= 3 && whole[0] != '0' && decimals.size() == 3;
    return (may_be_thousands && exponent.empty()) || (whole.empty() && decimals.empty()) ? '\0' : sign;
}

std::optional<double> decimal_number(std::string_view text, char decimal_sign) {
    const bool has_minus = text.starts_with(typographic_minus);
    if (decimal_sign == '.' && !has_minus) {
        return parse_number<double>(text);
    }
    std::string number = has_minus ? "-" + std::string(text.substr(typographic_minus.size())) : std::string(text);
    if (decimal_sign == ',') {
        if (number.find('.') != std::string::npos) {
            return std::nullopt;
        }
        if (const std::size_t comma = number.find(','); comma != std::string::npos) {
            number[comma] = '.';
        }
    }
    return parse_number<double>(number);
}

bool is_number(std::string_view text) {
    return decimal_number(text, '.') || decimal_number(text, ',');
}

WrittenDigits written_digits(std::string_view number) {
    const auto [mantissa, exponent] = parts_of(number);
    const std::size_t sign = std::min(mantissa.find_first_of(",."), mantissa.size());
    const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
    WrittenDigits digits;
    digits.decimals = static_cast<int>(mantissa.size()) - static_cast<int>(std::min(sign + 1, mantissa.size())) -
                      parse_number<int>(exponent).value_or(0);
    digits.significant = static_cast<int>(
        std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first), mantissa.end(), is_digit));
    return digits;
}

}  // namespace downwash
