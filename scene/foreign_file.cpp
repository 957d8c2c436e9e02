#include "downwash/scene/foreign_file.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
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

bool Lines::next() {
    words_.clear();
    while (words_.empty() && !rest_.empty()) {
        ++line_;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (words_.size() == max_words) {
                fail("has more than " + std::to_string(max_words) + " words: expected one statement in a line");
            }
            words_.push_back(word);
        }
    }
    return !words_.empty();
}

bool Lines::starts_with(std::string_view word) const {
    return !words_.empty() && is_same_word(words_[0], word);
}

double Lines::coordinate(std::string_view word) const {
    const auto number = parse_number<double>(word);
    if (!number || std::abs(*number) > max_coordinate) {
        fail("found '" + excerpt(word) + "', expected a finite number of at most 1e6 in size");
    }
    return *number;
}

void Lines::fail(const std::string& message) const {
    foreign::fail(name_, "line " + std::to_string(line_) + ": " + message);
}

}  // namespace downwash::foreign
