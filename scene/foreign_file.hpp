#pragma once

// What the readers of other programs' files share. Private to scene/.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/scene/shapes.hpp"

namespace downwash::foreign {

/// Larger files are rejected unread.
inline constexpr std::size_t max_file_bytes = 512UL * 1024 * 1024;
/// Lines of more words are errors: a word takes many times its memory in the file. A face of all triangles has less.
inline constexpr std::size_t max_words = max_pieces + 1000;
/// Largest size of a coordinate, in the file's unit; farther out, positions lose their tenths of a millimetre.
inline constexpr double max_coordinate = 1e6;

/// The bytes of a file. @throws InputError when it cannot be read or is too large
[[nodiscard]] std::string read(const std::filesystem::path& file);

/// @throws InputError "'name' message"
[[noreturn]] void fail(const std::string& name, const std::string& message);

/// @throws InputError "'name' byte 84: message", the first byte being 0
[[noreturn]] void fail_at(const std::string& name, std::size_t byte, const std::string& message);

/// A text, line by line, each as words between blanks.
class Lines {
 public:
    Lines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {}

    /// Moves to the next line that has words; false at the end of the text.
    /// @throws InputError when it has more than max_words
    bool next();
    /// Those of the current line.
    [[nodiscard]] const std::vector<std::string_view>& words() const noexcept { return words_; }
    /// Whether the current line begins with a word, in upper or lower case.
    [[nodiscard]] bool starts_with(std::string_view word) const;
    /// What follows the current line.
    [[nodiscard]] std::string_view rest() const noexcept { return rest_; }

    /// @throws InputError when a word of the current line is no finite number of at most max_coordinate in size
    [[nodiscard]] double coordinate(std::string_view word) const;
    /// @throws InputError "'name' line 7: message"
    [[noreturn]] void fail(const std::string& message) const;

 private:
    std::string_view rest_;
    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::string_view> words_;
};

// The formats behind read_mesh.

/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes, const std::string& name);
/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_obj(std::string_view text, const std::string& name);

}  // namespace downwash::foreign
