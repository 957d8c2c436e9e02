#include "downwash/base/base64.hpp"

#include <array>
#include <cstdint>

namespace downwash {
namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t no_letter = 64;

constexpr std::array<std::uint8_t, 256> values = [] {
    std::array<std::uint8_t, 256> all{};
    all.fill(no_letter);
    for (std::size_t i = 0; i < alphabet.size(); ++i) {
        all[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    }
    return all;
}();

}  // namespace

std::string base64_text(std::string_view bytes) {
    std::string text;
    text.reserve(base64_letters(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8U | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            const bool is_padding = j > bytes.size() - i;
            text += is_padding ? '=' : alphabet[group >> (18 - 6 * j) & 63U];
        }
    }
    return text;
}

std::optional<std::string> base64_bytes(std::string_view text) {
    if (text.size() % 4 != 0) {
        return std::nullopt;
    }
    const std::size_t padding = text.ends_with("==") ? 2 : (text.ends_with('=') ? 1 : 0);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (std::size_t i = 0; i < text.size(); i += 4) {
        const bool is_last = i + 4 == text.size();
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const bool is_padding = is_last && j >= 4 - padding;
            const std::uint8_t value = is_padding ? 0 : values[static_cast<unsigned char>(text[i + j])];
            if (value == no_letter) {
                return std::nullopt;
            }
            group = group << 6U | value;
        }
        for (std::size_t j = 0; j < (is_last ? 3 - padding : 3); ++j) {
            bytes += static_cast<char>(group >> (16 - 8 * j) & 255U);
        }
    }
    return bytes;
}

}  // namespace downwash
