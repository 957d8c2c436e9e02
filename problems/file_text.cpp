#include "downwash/problems/file_text.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "downwash/problems/yaml_document.hpp"

namespace downwash::problems {

std::string read_file_text(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        throw FileError("cannot be read: there is no such file");
    }
    if (status.type() == std::filesystem::file_type::directory) {
        throw FileError("cannot be read: it is a directory, expected a file");
    }
    if (status.type() == std::filesystem::file_type::none) {
        throw FileError("cannot be read: " + error.message());
    }
    if (status.type() != std::filesystem::file_type::regular) {
        throw FileError("cannot be read: expected an ordinary file");
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw FileError("cannot be read: " + std::generic_category().message(errno));
    }
    std::string text(largest_document + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) {
        throw FileError("cannot be read to its end");
    }
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

}  // namespace downwash::problems
