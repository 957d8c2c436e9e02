#include "downwash/problems/text_checks.hpp"

#include <algorithm>
#include <string>

#include "downwash/base/text.hpp"
#include "downwash/base/text_encoding.hpp"
#include "downwash/problems/yaml_node.hpp"

namespace downwash::problems {
namespace {

constexpr bool is_separator(char c) {
    return c == '\n' || c == ',' || c == ':' || c == '[' || c == '{';
}

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
}

}  // namespace

std::size_t separators_in(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), is_separator));
}

void check_text(std::string_view text) {
    if (text.size() > largest_document) {
        throw YamlError(
            {}, "is larger than " + std::to_string(largest_document / 1024) + " KiB: expected a problem or robot file");
    }
    if (is_utf16(text)) {
        throw YamlError({}, "is UTF-16 text: expected YAML in UTF-8; save it in that encoding");
    }
    if (separators_in(text) > most_separators) {
        throw YamlError({}, "has more than " + std::to_string(most_separators) +
                                " line breaks, commas, colons and brackets: expected a problem or robot file");
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
