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
/// Largest size of a coordinate, in the file's unit: beyond it numbers are no places. A scene wants its corners nearer
/// to their origin; an offset brings those of map coordinates there.
inline constexpr double max_coordinate = 1e10;

/// The bytes of a file. @throws InputError when it cannot be read or is too large
[[nodiscard]] std::string read(const std::filesystem::path& file);

/// @throws InputError "'name' message"
[[noreturn]] void fail(const std::string& name, const std::string& message);

/// @throws InputError "'name' byte 84: message", the first byte being 0
[[noreturn]] void fail_at(const std::string& name, std::size_t byte, const std::string& message);

/// A text without the byte order mark of UTF-8. @throws InputError when it is UTF-16
[[nodiscard]] std::string_view text_of(std::string_view bytes, const std::string& name);

/// Whether bytes begin with the byte order mark of UTF-16.
[[nodiscard]] bool has_utf16_mark(std::string_view bytes) noexcept;

/// @throws InputError that a file is UTF-16
[[noreturn]] void fail_for_utf16(const std::string& name);

/// Whether bytes are what editors and transfers leave behind a text: blanks, zeros, the end-of-file sign of DOS.
[[nodiscard]] bool is_padding(std::string_view bytes);

/// A text, line by line, each as words between blanks. Lines end with LF, CR LF or CR.
class Lines {
 public:
    /// Whether a line that ends with a backslash goes on in the next one, and a word that begins with # a comment up to
    /// its end, as in OBJ files.
    enum class Continuation { none, backslash };

    Lines(std::string_view text, std::string name, Continuation continuation = Continuation::none)
        : text_(text), name_(std::move(name)), continuation_(continuation) {}

    /// Moves to the next line that has words; false at the end of the text.
    /// @throws InputError when it has more than max_words
    bool next();
    /// Those of the current line.
    [[nodiscard]] const std::vector<std::string_view>& words() const noexcept { return words_; }
    /// Whether the current line begins with a word, in upper or lower case.
    [[nodiscard]] bool starts_with(std::string_view word) const;
    /// What follows the current line.
    [[nodiscard]] std::string_view rest() const noexcept { return text_.substr(at_); }
    /// The current line and what follows it.
    [[nodiscard]] std::string_view rest_with_line() const noexcept { return text_.substr(line_at_); }
    /// Number of the line on which the current one begins, from 1.
    [[nodiscard]] std::size_t number() const noexcept { return first_line_; }

    /// @throws InputError when a word of the current line is no finite number of at most max_coordinate in size
    [[nodiscard]] double coordinate(std::string_view word) const;
    /// @throws InputError "'name' line 7: message"
    [[noreturn]] void fail(const std::string& message) const;

 private:
    /// Takes the next line from the text.
    std::string_view take_line();
    /// Adds the words of a line; whether the next one continues it.
    bool add_words(std::string_view line);

    std::string_view text_;
    std::string name_;
    Continuation continuation_;
    std::size_t at_ = 0;            ///< first byte behind the current line
    std::size_t line_at_ = 0;       ///< first byte of the current line
    std::size_t line_feed_at_ = 0;  ///< the first line feed from at_ on, once looked for
    bool is_line_feed_known_ = false;
    std::size_t line_ = 0;
    std::size_t first_line_ = 0;
    std::vector<std::string_view> words_;
};

// The formats behind read_mesh.

/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes, const std::string& name);
/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_obj(std::string_view text, const std::string& name);

}  // namespace downwash::foreign
