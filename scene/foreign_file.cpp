#include "downwash/scene/foreign_file.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/number_remedy.hpp"
#include "downwash/base/text.hpp"

namespace downwash::foreign {

std::string read(const std::filesystem::path& file) {
    try {
        return read_whole_file(file, max_file_bytes);
    } catch (const FileError& error) {
        fail(file.string(), error.what());
    }
}

void fail(const std::string& name, const std::string& message) {
    throw_input_error("'" + name + "' " + message);
}

void fail_at(const std::string& name, std::size_t byte, const std::string& message) {
    fail(name, "byte " + std::to_string(byte) + ": " + message);
}

bool has_utf16_mark(std::string_view bytes) noexcept {
    return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
}

void fail_for_utf16(const std::string& name) {
    fail(name, "is UTF-16 text: expected ASCII or UTF-8; save it in that encoding");
}

std::string_view text_of(std::string_view bytes, const std::string& name) {
    const auto is_zero = [bytes](std::size_t i) { return bytes[i] == '\0'; };
    const bool has_every_other_zero =
        bytes.size() >= 4 && is_zero(0) == is_zero(2) && is_zero(1) == is_zero(3) && is_zero(0) != is_zero(1);
    if (has_utf16_mark(bytes) || has_every_other_zero) {
        fail_for_utf16(name);
    }
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return bytes.substr(bytes.starts_with(mark) ? mark.size() : 0);
}

bool is_padding(std::string_view bytes) {
    return std::all_of(bytes.begin(), bytes.end(),
                       [](char c) { return c == '\0' || c == '\x1a' || c == ' ' || (c >= '\t' && c <= '\r'); });
}

bool Lines::next() {
    words_.clear();
    while (words_.empty() && at_ < text_.size()) {
        line_at_ = at_;
        first_line_ = line_ + 1;
        while (add_words(take_line()) && at_ < text_.size()) {
        }
    }
    return !words_.empty();
}

std::string_view Lines::take_line() {
    if (!is_line_feed_known_ || line_feed_at_ < at_) {
        line_feed_at_ = std::min(text_.find('\n', at_), text_.size());
        is_line_feed_known_ = true;
    }
    const std::size_t begin = at_;
    const std::size_t end = std::min(text_.substr(0, line_feed_at_).find('\r', begin), line_feed_at_);
    at_ = std::min(end + 1, text_.size());
    if (end + 1 == line_feed_at_ && text_[end] == '\r') {
        at_ = std::min(at_ + 1, text_.size());
    }
    ++line_;
    return text_.substr(begin, end - begin);
}

bool Lines::add_words(std::string_view line) {
    const std::string_view content = trimmed(line);
    const bool is_obj = continuation_ == Continuation::backslash;
    const bool continues = is_obj && content.ends_with('\\');
    std::string_view rest = continues ? content.substr(0, content.size() - 1) : content;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
        if (is_obj && word.starts_with('#')) {
            return false;
        }
        if (words_.size() == max_words) {
            fail("has more than " + std::to_string(max_words) + " words: expected one statement in a line");
        }
        words_.push_back(word);
    }
    return continues;
}

bool Lines::starts_with(std::string_view word) const {
    return !words_.empty() && is_same_word(words_[0], word);
}

double Lines::coordinate(std::string_view word) const {
    const auto number = parse_number<double>(word);
    if (!number || std::abs(*number) > max_coordinate) {
        fail("found '" + excerpt(word) + "', expected a finite number of at most 1e10 in size" + number_remedy(word));
    }
    return *number;
}

void Lines::fail(const std::string& message) const {
    foreign::fail(name_, "line " + std::to_string(first_line_) + ": " + message);
}

}  // namespace downwash::foreign
