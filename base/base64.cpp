#include "downwash/base/base64.hpp"

#include <openssl/evp.h>

#include <climits>
#include <utility>

namespace downwash {

std::string base64_text(std::string_view bytes) {
    std::string text(base64_letters(bytes.size()) + 1, '\0');  // OpenSSL closes it with a zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), reinterpret_cast<const unsigned char*>(bytes.data()),
                    static_cast<int>(bytes.size()));
    text.pop_back();
    return text;
}

std::optional<std::string> base64_bytes(std::string_view text) {
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
    return base64_text(bytes) == text ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace downwash
