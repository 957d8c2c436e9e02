#pragma once

// Private: not installed.

#include <cstddef>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Foreign text in a form for pictures: one line of valid UTF-8 that XML can hold, cut after a number of characters.
/// Characters that cannot be shown become a space or a question mark, and ' becomes ’.
[[nodiscard]] DOWNWASH_EXPORT std::string picture_text(std::string_view text, std::size_t max_characters = 100);

/// A text as a string for gnuplot, in single quotes, in which gnuplot replaces and runs nothing.
[[nodiscard]] DOWNWASH_EXPORT std::string in_quotes(std::string_view text);

/// The approximate width of picture_text(text) in a sans-serif font of this size [px].
[[nodiscard]] double text_width_px(std::string_view text, double font_px);

}  // namespace downwash
