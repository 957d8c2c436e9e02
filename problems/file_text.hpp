#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace downwash::problems {

/// A file cannot be read; what() continues its name: "cannot be read: there is no such file".
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The bytes of a regular file. @throws FileError when there is none, or it is larger than a problem can be
[[nodiscard]] std::string read_file_text(const std::filesystem::path& file);

}  // namespace downwash::problems
