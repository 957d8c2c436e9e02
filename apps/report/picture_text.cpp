#include "downwash/report/picture_text.hpp"

#include <cstdint>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

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
        const std::size_t length = utf8_length(text);
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
