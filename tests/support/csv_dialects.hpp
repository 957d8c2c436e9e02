#pragma once

// Tables as other programs write them: spreadsheets, test stands, pandas, numpy and R.

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/text.hpp"
#include "random.hpp"

namespace downwash::test {

/// The names of columns, then rows; numbers have decimal points.
using CsvRows = std::vector<std::vector<std::string>>;

/// How a table is written.
struct CsvDialect {
    std::string separator, variant, line_end, encoding;
    bool has_decimal_comma = false, has_quotes = false;

    /// Whether separators, decimal commas and empty cells can be told apart.
    [[nodiscard]] bool can_be_read() const {
        const bool has_plain_commas = has_decimal_comma && !has_quotes;
        if (separator != "  ") {
            return !(has_plain_commas && separator[0] == ',');
        }
        return variant == "plain" || variant == "comment" || (variant == "names in a comment" && !has_plain_commas);
    }
    [[nodiscard]] std::string name() const {
        return "'" + separator + "' " + variant +
               (line_end == "\r"   ? " CR "
                : line_end == "\n" ? " LF "
                                   : " CR LF ") +
               encoding + (has_decimal_comma ? " decimal comma" : "") + (has_quotes ? " quotes" : "");
    }
};

/// Every dialect in which a table without empty cells can be told from others.
inline std::vector<CsvDialect> csv_dialects() {
    std::vector<CsvDialect> all;
    for (const char* separator : {",", ";", "\t", ", ", " ; ", "  "}) {
        for (const bool has_decimal_comma : {false, true}) {
            for (const bool has_quotes : {false, true}) {
                for (const char* variant : {"plain", "comment", "empty last column", "index without a name",
                                            "Unnamed: 0", "sep=", "rows without content", "names in a comment"}) {
                    for (const char* line_end : {"\n", "\r\n", "\r"}) {
                        for (const char* encoding : {"UTF-8", "UTF-8 with mark", "Latin-1", "UTF-16LE with mark",
                                                     "UTF-16BE with mark", "UTF-16LE", "UTF-16BE"}) {
                            const CsvDialect dialect{separator, variant,           line_end,
                                                     encoding,  has_decimal_comma, has_quotes};
                            if (dialect.can_be_read()) {
                                all.push_back(dialect);
                            }
                        }
                    }
                }
            }
        }
    }
    return all;
}

/// @param text UTF-8 of characters up to U+FFFF; for Latin-1 up to U+00FF
inline std::string encoded(std::string_view text, const std::string& encoding) {
    if (encoding.starts_with("UTF-8")) {
        return (encoding.ends_with("mark") ? "\xEF\xBB\xBF" : "") + std::string(text);
    }
    std::string bytes;
    const auto append = [&](std::uint32_t character) {
        const char low = static_cast<char>(character & 0xFFU);
        const char high = static_cast<char>(character >> 8U);
        bytes += encoding == "Latin-1"             ? std::string{low}
                 : encoding.starts_with("UTF-16L") ? std::string{low, high}
                                                   : std::string{high, low};
    };
    if (encoding.ends_with("mark")) {
        append(0xFEFF);
    }
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        auto character = static_cast<std::uint32_t>(static_cast<unsigned char>(text[0]));
        character &= length == 1 ? 0x7FU : length == 2 ? 0x1FU : 0x0FU;
        for (std::size_t i = 1; i < length; ++i) {
            character = character << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
        }
        append(character);
        text.remove_prefix(length);
    }
    return bytes;
}

/// A number of thousandths in one of the ways in which programs write it.
inline std::string spelled(int thousandths, Random& random) {
    std::array<char, 32> text{};
    const double number = thousandths / 1000.;
    constexpr std::array formats{"%.3f", "%.6f", "%g", "%.3e", "%.18e", "%+.3f", "%.3E"};
    std::snprintf(text.data(), text.size(), formats[static_cast<std::size_t>(random.integer(0, 6))], number);
    std::string spelled(text.data());
    if (spelled.starts_with("0.") && random.integer(0, 1) == 0) {
        spelled.erase(0, 1);
    }
    return spelled;
}

/// The bytes of a file. @param random draws how minus signs look
inline std::string csv_file(const CsvRows& rows, const CsvDialect& dialect, Random& random) {
    const std::string& separator = dialect.separator;
    const std::string& variant = dialect.variant;
    std::string text;
    if (variant == "comment" || variant == "names in a comment") {
        text +=
            "# Pr\xC3\xBC"
            "fstand 2; 13\" rotor\n";
    } else if (variant == "sep=") {
        const std::size_t mark = separator.find_first_not_of(' ');
        text += std::string("sep=") + separator[mark] + "\n";
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (variant == "rows without content" && i == rows.size() / 2) {
            text += "\n" + joined(std::vector<std::string>(rows[0].size()), separator) + "\n \n";
        }
        std::vector<std::string> cells;
        if (variant == "index without a name" || variant == "Unnamed: 0") {
            cells.push_back(i > 0 ? std::to_string(i - 1) : variant == "Unnamed: 0" ? variant : "");
        }
        for (std::string cell : rows[i]) {
            if (i > 0 && parse_number<double>(cell)) {
                const bool has_typographic_minus =
                    cell[0] == '-' && dialect.encoding != "Latin-1" && random.integer(0, 1) == 0;
                cell = has_typographic_minus ? "\xE2\x88\x92" + cell.substr(1) : cell;
                const std::size_t point = cell.find('.');
                if (dialect.has_decimal_comma && point != std::string::npos) {
                    cell[point] = ',';
                }
            }
            cells.push_back(std::move(cell));
        }
        if (variant == "empty last column") {
            cells.emplace_back();
        }
        text += i == 0 && variant == "names in a comment" ? "# " : "";
        text += joined(cells, separator,
                       [&](const std::string& cell) { return dialect.has_quotes ? '"' + cell + '"' : cell; });
        text += "\n";
    }
    if (random.integer(0, 1) == 0) {
        text.pop_back();
    }
    std::string with_ends;
    for (const char c : text) {
        with_ends += c == '\n' ? dialect.line_end : std::string(1, c);
    }
    return encoded(with_ends, dialect.encoding);
}

}  // namespace downwash::test
