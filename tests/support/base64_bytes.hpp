#pragma once

#include <openssl/evp.h>

#include <climits>
#include <optional>
#include <string>
#include <string_view>

#include "downwash/base/base64.hpp"

namespace downwash::test {

/// The bytes that base64_text() turns into this text; empty when there are none: a length that is no multiple of 4,
/// another letter, padding before the end, bits set in what the padding leaves over.
inline std::optional<std::string> base64_bytes(std::string_view text) {
    if (text.size() % 4 != 0 || text.size() > INT_MAX) {
        return std::nullopt;
    }
    std::string bytes(text.size() / 4 * 3, '\0');
    const int size =
        EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                        reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
    const std::size_t padding = text.ends_with("==") ? 2 : (text.ends_with('=') ? 1 : 0);
    if (size < static_cast<int>(padding)) {
        return std::nullopt;
    }
    bytes.resize(static_cast<std::size_t>(size) - padding);
    // OpenSSL overlooks blanks around the text and padding within it: only a text that comes out again is sound.
    return base64_text(bytes) == text ? std::optional(bytes) : std::nullopt;
}

}  // namespace downwash::test
