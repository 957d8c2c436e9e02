#pragma once

#include <optional>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// What ends lines: the line feed, or the carriage return if no line feed stands outside quotation marks.
[[nodiscard]] DOWNWASH_EXPORT char line_end_of(std::string_view text);

/// What separates the cells of a line outside quotation marks: `;`, a tab, `,` or blanks (a space); `,` for one cell.
[[nodiscard]] DOWNWASH_EXPORT char separator_of(std::string_view line);

/// The decimal sign of a number, `.` or `,`; 0 for another text, and if the sign may also stand between thousands
/// ("1,234", "1.234").
[[nodiscard]] DOWNWASH_EXPORT char decimal_sign_of(std::string_view cell);

/// The number that a text spells with that decimal sign, `.` or `,`; the minus sign may be the typographer's. Empty if
/// it spells none that is finite.
[[nodiscard]] DOWNWASH_EXPORT std::optional<double> decimal_number(std::string_view text, char decimal_sign);

/// Whether a text spells a number with either decimal sign.
[[nodiscard]] DOWNWASH_EXPORT bool is_number(std::string_view text);

/// How a number is written: "-0.0120" has 4 decimals and 3 significant digits, "1.5e3" -2 and 2.
struct WrittenDigits {
    int decimals = 0;
    int significant = 0;
};

/// @param number a text that is a number, with either decimal sign
[[nodiscard]] DOWNWASH_EXPORT WrittenDigits written_digits(std::string_view number);

}  // namespace downwash
