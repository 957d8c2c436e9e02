#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// A file cannot be read or written; what() continues its name: "cannot be read: there is no such file".
struct DOWNWASH_EXPORT FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The first bytes of a regular file, at most so many: ask for one more than you accept to notice a file that is too
/// large. @throws FileError when there is none or it cannot be read
[[nodiscard]] DOWNWASH_EXPORT std::string read_file(const std::filesystem::path& file, std::size_t most_bytes);

/// Writes a file beside its place and moves it there: whoever looks finds the old file, or the whole new one. A
/// symbolic link stays; what it leads to is written.
/// @throws FileError when that fails; nothing is left behind then
DOWNWASH_EXPORT void write_file(const std::filesystem::path& file, std::string_view content);

/// Whether write_file would get as far as its first byte. @throws FileError when it would not
DOWNWASH_EXPORT void require_writable(const std::filesystem::path& file);

}  // namespace downwash
