#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Bytes as RFC 4648 writes them, padded, without line breaks. @pre at most 1.5 GB
[[nodiscard]] DOWNWASH_EXPORT std::string base64_text(std::string_view bytes);

/// Letters of the text of so many bytes.
[[nodiscard]] constexpr std::size_t base64_letters(std::size_t bytes) noexcept {
    return (bytes + 2) / 3 * 4;
}

}  // namespace downwash
