#include "downwash/base/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <vector>

namespace downwash {
namespace {

/// Longer words are not misspelt names.
constexpr std::size_t longest_word = 64;

bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Letters to insert, delete, replace or swap with their neighbour to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last, last, row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last = last;
        last = row;
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

}  // namespace

std::string to_text(double value) {
    std::array<char, 32> text;
    const double size = std::abs(value);
    const auto format = size >= 1e-4 && size < 1e15 ? std::chars_format::fixed : std::chars_format::general;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format).ptr;
    return {text.data(), end};
}

std::string to_text(double value, int significant_digits) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general,
                                   std::clamp(significant_digits, 1, 17))
                         .ptr;
    return {text.data(), end};
}

std::string to_fixed_text(double value, int decimals) {
    std::array<char, 400> text;  // the largest number has 309 digits before the point
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed,
                                   std::clamp(decimals, 0, 17))
                         .ptr;
    const std::string_view written(text.data(), static_cast<std::size_t>(end - text.data()));
    const bool is_negative_zero =
        written.starts_with('-') && written.find_first_not_of("-0.") == std::string_view::npos;
    return std::string(is_negative_zero ? written.substr(1) : written);
}

std::string_view trimmed(std::string_view text) {
    const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
    const auto end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), is_blank).base();
    return {begin, end};
}

std::string_view take_word(std::string_view& rest) {
    const auto begin = std::find_if_not(rest.begin(), rest.end(), is_blank);
    const auto end = std::find_if(begin, rest.end(), is_blank);
    rest = {end, rest.end()};
    return {begin, end};
}

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> candidates) {
    if (word.size() > longest_word) {
        return {};
    }
    std::string_view nearest;
    std::size_t min_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string_view candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < min_distance) {
            min_distance = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::size_t utf8_length(std::string_view text) {
    /// First bytes of characters, the range of the byte behind, and how many bytes there are: all others are 80 to BF.
    struct Row {
        unsigned char first, last, second_low, second_high;
        std::size_t length;
    };
    constexpr std::array rows{Row{0xC2, 0xDF, 0x80, 0xBF, 2}, Row{0xE0, 0xE0, 0xA0, 0xBF, 3},
                              Row{0xE1, 0xEC, 0x80, 0xBF, 3}, Row{0xED, 0xED, 0x80, 0x9F, 3},
                              Row{0xEE, 0xEF, 0x80, 0xBF, 3}, Row{0xF0, 0xF0, 0x90, 0xBF, 4},
                              Row{0xF1, 0xF3, 0x80, 0xBF, 4}, Row{0xF4, 0xF4, 0x80, 0x8F, 4}};
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) {
        return 1;
    }
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return byte(0) >= r.first && byte(0) <= r.last; });
    if (row == rows.end() || text.size() < row->length || byte(1) < row->second_low || byte(1) > row->second_high) {
        return 0;
    }
    const std::string_view rest = text.substr(2, row->length - 2);
    const bool is_whole =
        std::all_of(rest.begin(), rest.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; });
    return is_whole ? row->length : 0;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0) {
            return false;
        }
        text.remove_prefix(length);
    }
    return true;
}

bool is_same_word(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

std::string excerpt(std::string_view text) {
    constexpr std::size_t longest = 48;
    constexpr std::string_view digits = "0123456789abcdef";
    std::string shown;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t length = utf8_length(text.substr(at));
        if (at + std::max<std::size_t>(length, 1) > longest) {
            break;
        }
        const auto byte = static_cast<unsigned char>(text[at]);
        // C2 80 to C2 9F are control characters like those below 20, and as such speak to terminals.
        const bool is_control = byte < 0x20 || byte == 0x7F ||
                                (byte == 0xC2 && length == 2 && static_cast<unsigned char>(text[at + 1]) < 0xA0);
        if (length == 0) {
            shown.append("\\x").append({digits[byte >> 4U], digits[byte & 15U]});
        } else if (is_control) {
            shown += ' ';
        } else {
            shown += text.substr(at, length);
        }
        at += std::max<std::size_t>(length, 1);
    }
    return at < text.size() ? shown + "..." : shown;
}

std::string joined_names(std::span<const std::string_view> names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) {
            text += i + 1 == names.size() ? " or " : ", ";
        }
        text += names[i];
    }
    return text;
}

}  // namespace downwash
