#include "downwash/problems/text_checks.hpp"

#include <string>

#include "downwash/problems/yaml_document.hpp"

namespace downwash::problems {
namespace {

/// Bytes of the well-formed UTF-8 sequence at the start of the text (RFC 3629); 0 when there is none.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const auto follows = [&byte](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
    const unsigned first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    if (first >= 0xC2 && first <= 0xDF) {
        return follows(1) ? 2 : 0;
    }
    if (first >= 0xE0 && first <= 0xEF) {
        const bool is_overlong = first == 0xE0 && byte(1) < 0xA0;
        const bool is_surrogate = first == 0xED && byte(1) >= 0xA0;
        return !is_overlong && !is_surrogate && follows(1) && follows(2) ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        const bool is_overlong = first == 0xF0 && byte(1) < 0x90;
        const bool is_beyond = first == 0xF4 && byte(1) >= 0x90;
        return !is_overlong && !is_beyond && follows(1) && follows(2) && follows(3) ? 4 : 0;
    }
    return 0;
}

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
}

}  // namespace

void check_text(std::string_view text) {
    if (text.size() > largest_document) {
        throw YamlError(
            {}, "is larger than " + std::to_string(largest_document / 1024) + " KiB: expected a problem or robot file");
    }
    Mark here;
    bool is_indentation = true;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        const std::size_t length = utf8_length(text.substr(i));
        if (length == 0 || is_control(c)) {
            throw YamlError(here, "holds bytes that are no text: expected YAML in UTF-8");
        }
        if (c == '\t' && is_indentation) {
            throw YamlError(here, "a tab in the indentation: expected spaces");
        }
        is_indentation = c == '\n' || (is_indentation && c == ' ');
        here.column += static_cast<int>(length);
        if (c == '\n') {
            ++here.line;
            here.column = 1;
        }
        i += length;
    }
}

}  // namespace downwash::problems
