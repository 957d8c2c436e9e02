#pragma once

// Private: not installed.

#include <cstddef>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Text of others as it may stand in a picture: one line of valid UTF-8 that XML can hold, cut after so many
/// characters. What cannot be shown becomes a space or a question mark, and ' becomes ’.
[[nodiscard]] DOWNWASH_EXPORT std::string picture_text(std::string_view text, std::size_t most_characters = 100);

/// The same as a string of gnuplot, in single quotes, within which gnuplot replaces and runs nothing.
[[nodiscard]] DOWNWASH_EXPORT std::string in_quotes(std::string_view text);

/// About how wide picture_text(text) is in a sans-serif font of this size [px].
[[nodiscard]] double text_width_px(std::string_view text, double font_px);

}  // namespace downwash
