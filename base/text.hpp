#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "downwash/base/export.hpp"

namespace downwash {

/// The shortest decimal that reads back as the very same number, whatever the locale.
[[nodiscard]] DOWNWASH_EXPORT std::string to_text(double value);

/// A number for people to read, rounded to so many significant digits (1 to 17).
[[nodiscard]] DOWNWASH_EXPORT std::string to_text(double value, int significant_digits);

/// A number for people to read with so many decimals (0 to 17), and no minus sign before zero.
[[nodiscard]] DOWNWASH_EXPORT std::string to_fixed_text(double value, int decimals);

/// The number that a whole text spells ("3", "-.5", "+1e3"); empty if it spells none, or one that is not finite or out
/// of the type's range. Independent of the locale.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
        text.remove_prefix(1);  // from_chars knows no plus sign
    }
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    if constexpr (std::is_floating_point_v<Number>) {
        if (!std::isfinite(number)) {
            return std::nullopt;
        }
    }
    return number;
}

/// The text without the blanks (tabs and ends of lines are some) at both ends.
[[nodiscard]] DOWNWASH_EXPORT std::string_view trimmed(std::string_view text);

/// Takes the next word, which ends at a blank or an end of line, from the front of a text; empty if there is none.
[[nodiscard]] DOWNWASH_EXPORT std::string_view take_word(std::string_view& rest);

/// The candidate that a misspelt word most likely means; empty if none is near (more than a third of its letters would
/// have to change).
[[nodiscard]] DOWNWASH_EXPORT std::string_view nearest_name(std::string_view word,
                                                            std::span<const std::string_view> candidates);

/// Length in bytes of the well-formed UTF-8 character that a text begins with (Unicode 15, table 3-7); 0 if it begins
/// with none. @pre the text is not empty
[[nodiscard]] DOWNWASH_EXPORT std::size_t utf8_length(std::string_view text);

/// Whether a text is well-formed UTF-8.
[[nodiscard]] DOWNWASH_EXPORT bool is_utf8(std::string_view text);

/// Whether two words are equal but for the case of their ASCII letters.
[[nodiscard]] DOWNWASH_EXPORT bool is_same_word(std::string_view a, std::string_view b);

/// A user's text for a message: on one line, cut after about fifty bytes but never within a character. Control
/// characters become blanks, and bytes that are no UTF-8 hexadecimal numbers ("\xff"), so that terminals get text only.
[[nodiscard]] DOWNWASH_EXPORT std::string excerpt(std::string_view text);

/// The texts of some values with a separator between them.
/// @param text (value) -> its text
template <class Values, class Text = std::identity>
[[nodiscard]] std::string joined(const Values& values, std::string_view separator, const Text& text = {}) {
    std::string all;
    bool is_first = true;
    for (const auto& value : values) {
        all.append(std::exchange(is_first, false) ? std::string_view() : separator).append(text(value));
    }
    return all;
}

/// "a, b or c". Empty without names.
[[nodiscard]] DOWNWASH_EXPORT std::string joined_names(std::span<const std::string_view> names);

}  // namespace downwash
