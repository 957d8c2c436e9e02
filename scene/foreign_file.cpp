#include "downwash/scene/foreign_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash::foreign {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::string read(const std::filesystem::path& file) {
    std::error_code unknown;  // of what is no regular file; it is read as far as allowed
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    if (unknown || size <= largest_file) {
        try {
            std::string bytes = read_file(file, largest_file + 1);
            if (bytes.size() <= largest_file) {
                return bytes;
            }
        } catch (const FileError& error) {
            refuse(file.string(), error.what());
        }
    }
    refuse(file.string(), "is larger than " + std::to_string(largest_file / 1024 / 1024) + " MiB: expected less");
}

void refuse(const std::string& name, const std::string& message) {
    throw InputError({{"", "'" + name + "' " + message}});
}

void refuse_at(const std::string& name, std::size_t byte, const std::string& message) {
    refuse(name, "byte " + std::to_string(byte) + ": " + message);
}

bool is_same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

bool Lines::next() {
    words_.clear();
    while (words_.empty() && !rest_.empty()) {
        ++line_;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;
             at = line.find_first_not_of(blanks)) {
            line.remove_prefix(at);
            const std::size_t length = std::min(line.find_first_of(blanks), line.size());
            words_.push_back(line.substr(0, length));
            line.remove_prefix(length);
        }
    }
    return !words_.empty();
}

bool Lines::starts_with(std::string_view word) const {
    return !words_.empty() && is_same_word(words_[0], word);
}

double Lines::coordinate(std::string_view word) const {
    const auto number = parse_number<double>(word);
    if (!number || std::abs(*number) > greatest_coordinate) {
        refuse("found '" + excerpt(word) + "', expected a finite number of at most 1e6 in size");
    }
    return *number;
}

void Lines::refuse(const std::string& message) const {
    foreign::refuse(name_, "line " + std::to_string(line_) + ": " + message);
}

}  // namespace downwash::foreign
