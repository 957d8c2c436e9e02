#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash {

/// A file cannot be read or written; what() continues its name: "cannot be read: there is no such file".
struct DOWNWASH_EXPORT FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The first bytes of a regular file, at most so many. @throws FileError if there is none or it cannot be read
[[nodiscard]] DOWNWASH_EXPORT std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);

/// The bytes of a regular file. @throws FileError if there is none, it cannot be read or has more than `max_bytes`
[[nodiscard]] DOWNWASH_EXPORT std::string read_whole_file(const std::filesystem::path& file, std::size_t max_bytes);

/// Writes a file beside its place and moves it there: a reader finds either the old file or the whole new one. If the
/// file is a symbolic link, writes its target.
/// @throws FileError if that fails; then no file is left behind
DOWNWASH_EXPORT void write_file(const std::filesystem::path& file, std::string_view content);

/// @throws FileError if write_file could not begin to write this file
DOWNWASH_EXPORT void require_writable(const std::filesystem::path& file);

/// Does something with a file, and names the file if that fails. @throws InputError
template <class Use>
auto naming(const std::filesystem::path& file, const Use& use) {
    try {
        return use();
    } catch (const FileError& error) {
        throw_input_error(file.string() + " " + error.what());
    }
}

}  // namespace downwash
