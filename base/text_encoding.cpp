#include "downwash/base/text_encoding.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

using namespace std::string_view_literals;

constexpr std::uint32_t replacement = 0xFFFD;  ///< for what is no character

void append_utf8(std::string& text, std::uint32_t character) {
    const auto append = [&text](std::uint32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    const auto append_tail = [&append, character](int shift) { append(0x80U | ((character >> shift) & 0x3FU)); };
    if (character < 0x80) {
        append(character);
    } else if (character < 0x800) {
        append(0xC0U | (character >> 6U));
        append_tail(0);
    } else if (character < 0x10000) {
        append(0xE0U | (character >> 12U));
        append_tail(6);
        append_tail(0);
    } else {
        append(0xF0U | (character >> 18U));
        append_tail(12);
        append_tail(6);
        append_tail(0);
    }
}

/// @param low where the low byte of a pair stands: 0 (little-endian) or 1
std::string from_utf16(std::string_view bytes, std::size_t low) {
    const auto unit = [&](std::size_t i) {
        const auto byte = [&](std::size_t at) { return std::uint32_t{static_cast<unsigned char>(bytes[at])}; };
        return byte(i + low) | (byte(i + 1 - low) << 8U);
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        const std::uint32_t first = unit(i);
        if (first < 0xD800 || first > 0xDFFF) {
            append_utf8(text, first);
            continue;
        }
        const std::uint32_t second = first < 0xDC00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
        if (second >= 0xDC00 && second <= 0xDFFF) {
            append_utf8(text, 0x10000 + ((first - 0xD800) << 10U) + (second - 0xDC00));
            i += 2;
        } else {
            append_utf8(text, replacement);
        }
    }
    return text;
}

/// Bytes that are not UTF-8 as Latin-1, all others as they are.
std::string from_latin1(std::string_view bytes) {
    std::string text;
    text.reserve(bytes.size() + bytes.size() / 8);
    while (!bytes.empty()) {
        const std::size_t length = utf8_length(bytes);
        if (length > 0) {
            text += bytes.substr(0, length);
        } else {
            const auto byte = static_cast<unsigned char>(bytes[0]);
            append_utf8(text, byte < 0xA0 ? replacement : byte);
        }
        bytes.remove_prefix(std::max<std::size_t>(1, length));
    }
    return text;
}

/// Whether every second byte of the beginning is zero, and no other.
bool has_zeros(std::string_view bytes, std::size_t from) {
    constexpr std::size_t enough = 16;
    const std::size_t looked_at = std::min(enough, bytes.size() / 2 * 2);
    for (std::size_t i = 0; i < looked_at; ++i) {
        if ((bytes[i] == 0) != (i % 2 == from)) {
            return false;
        }
    }
    return looked_at > 0;
}

bool is_utf32(std::string_view bytes) {
    return bytes.starts_with("\xFF\xFE\0\0"sv) || bytes.starts_with("\0\0\xFE\xFF"sv);
}

bool has_utf16_mark(std::string_view bytes) {
    return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
}

}  // namespace

bool is_utf16(std::string_view bytes) {
    return !is_utf32(bytes) && (has_utf16_mark(bytes) || has_zeros(bytes, 1) || has_zeros(bytes, 0));
}

Utf8Text utf8_text(std::string_view bytes) {
    Utf8Text text;
    if (is_utf32(bytes)) {
        text.error = "is UTF-32 text: expected UTF-8";
        return text;
    }
    if (has_utf16_mark(bytes)) {
        text.converted = from_utf16(bytes.substr(2), bytes[0] == '\xFF' ? 0 : 1);
    } else if (has_zeros(bytes, 1) || has_zeros(bytes, 0)) {
        text.converted = from_utf16(bytes, has_zeros(bytes, 1) ? 0 : 1);
    } else {
        text.given = bytes.substr(bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
        if (!is_utf8(text.given)) {
            text.converted = from_latin1(text.given);
        }
    }
    if (const auto zero = text.view().find('\0'); zero != std::string_view::npos) {
        text.error = "holds a zero byte: expected text";
    }
    return text;
}

}  // namespace downwash
