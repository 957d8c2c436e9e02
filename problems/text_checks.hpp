#pragma once

#include <cstddef>
#include <string_view>

namespace downwash::problems {

/// Larger problem and robot files are refused unread [bytes].
inline constexpr std::size_t largest_document = 32UL * 1024 * 1024;

/// A text with more separators is refused unread: each may stand for a value or two, and each of these takes up to
/// 300 bytes of memory while the text is read. A scene of 100,000 boxes with every default filled in has 1.9 million.
inline constexpr std::size_t most_separators = 2500000;

/// Line breaks, commas, colons, opening brackets and braces.
[[nodiscard]] std::size_t separators_in(std::string_view text);

/// Refuses what a YAML parser should never see.
/// @throws YamlError when the text is too large, has too many separators, holds NUL or other control bytes, invalid
/// UTF-8 or tabs in indentation
void check_text(std::string_view text);

}  // namespace downwash::problems
