#include "downwash/report/picture_text.hpp"

#include <cstdint>

namespace downwash {
namespace {

/// Length in bytes of the well-formed UTF-8 character that the text begins with; 0 when it begins with none.
/// (Unicode 15, table 3-7.)
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) -> unsigned {
        return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0U;
    };
    const auto continues = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xbf) {
        return byte(i) >= low && byte(i) <= high;
    };
    const unsigned first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    if (first >= 0xc2 && first <= 0xdf) {
        return continues(1) ? 2 : 0;
    }
    if (first >= 0xe0 && first <= 0xef) {
        const bool is_valid = continues(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf) && continues(2);
        return is_valid ? 3 : 0;
    }
    if (first >= 0xf0 && first <= 0xf4) {
        const bool is_valid =
            continues(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf) && continues(2) && continues(3);
        return is_valid ? 4 : 0;
    }
    return 0;
}

bool is_control(std::string_view character) {
    const auto first = static_cast<std::uint8_t>(character[0]);
    return (character.size() == 1 && (first < 0x20 || first == 0x7f)) ||
           (character.size() == 2 && first == 0xc2 && static_cast<std::uint8_t>(character[1]) < 0xa0);
}

}  // namespace

std::string picture_text(std::string_view text, std::size_t max_characters) {
    std::string shown;
    for (std::size_t count = 0; !text.empty(); ++count) {
        if (count == max_characters) {
            return shown + "…";
        }
        const std::size_t length = character_length(text);
        const std::string_view character = text.substr(0, length);
        if (length == 0 || character == "\xef\xbf\xbe" || character == "\xef\xbf\xbf") {
            shown += '?';
        } else if (is_control(character)) {
            shown += ' ';
        } else if (character == "'") {
            shown += "’";
        } else {
            shown += character;
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return shown;
}

std::string in_quotes(std::string_view text) {
    // No apostrophe is left inside. Doubling them would not do: gnuplot reads ''' as an empty string and the beginning
    // of another.
    return "'" + picture_text(text) + "'";
}

double text_width_px(std::string_view text, double font_px) {
    // Of DejaVu Sans.
    constexpr double narrow_em = 0.36, usual_em = 0.62, capital_em = 0.71, broad_em = 0.95;
    double em = 0;
    for (const char c : picture_text(text)) {
        const auto byte = static_cast<std::uint8_t>(c);
        if (std::string_view(" .,:;'|()[]!/ijlftr").find(c) != std::string_view::npos) {
            em += narrow_em;
        } else if (std::string_view("mwMW@%").find(c) != std::string_view::npos || byte >= 0xe3) {  // from U+3000: CJK
            em += broad_em;
        } else if (c >= 'A' && c <= 'Z') {
            em += capital_em;
        } else if (byte < 0x80 || byte >= 0xc0) {  // the first byte of a character
            em += usual_em;
        }
    }
    return em * font_px;
}

}  // namespace downwash
