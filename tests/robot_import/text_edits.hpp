#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace downwash::test {

using TextEdits = std::vector<std::pair<std::string, std::string>>;

inline std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

/// The text with the first of each part replaced. Fails the test where there is none.
inline std::string edited(std::string text, const TextEdits& edits) {
    for (const auto& [part, by] : edits) {
        const std::size_t at = text.find(part);
        INFO(part);
        REQUIRE(at != std::string::npos);
        text.replace(at, part.size(), by);
    }
    return text;
}

/// The text with every part replaced.
inline std::string edited_all(std::string text, const std::string& part, const std::string& by) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size())) {
        text.replace(at, part.size(), by);
    }
    return text;
}

}  // namespace downwash::test
