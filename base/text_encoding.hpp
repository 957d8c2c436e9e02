#pragma once

#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// The text of a file as UTF-8, however the file encodes it.
struct Utf8Text {
    std::string converted;   ///< holds the text if the file is not UTF-8
    std::string_view given;  ///< the bytes of the file behind a byte order mark, if they are UTF-8
    std::string error;       ///< why there is no text: UTF-32, or bytes that are no text; empty if there is one

    [[nodiscard]] std::string_view view() const noexcept { return converted.empty() ? given : converted; }
};

/// Whether bytes are UTF-16: they have its byte order mark, or every other one of the first is zero.
[[nodiscard]] DOWNWASH_EXPORT bool is_utf16(std::string_view bytes);

/// Reads UTF-8, UTF-16, and Latin-1 where bytes are not UTF-8.
/// @param bytes must outlive the result
[[nodiscard]] DOWNWASH_EXPORT Utf8Text utf8_text(std::string_view bytes);

}  // namespace downwash
