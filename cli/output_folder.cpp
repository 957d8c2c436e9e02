#include "downwash/cli/output_folder.hpp"

#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {

namespace fs = std::filesystem;

void write_result(const fs::path& file, std::string_view content) {
    try {
        write_file(file, content);
    } catch (const FileError& error) {
        throw UsageError(file.string() + " " + error.what());
    }
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (!fs::is_directory(path_)) {
        throw UsageError("--out " + path_.string() +
                         " cannot be made a folder: " + (error ? error.message() : "it is not one"));
    }
    const fs::path trial = path_ / "solution.json";
    try {
        require_writable(trial);
    } catch (const FileError& failed) {
        throw UsageError(trial.string() + " " + failed.what() + "; choose another folder with --out");
    }
}

void OutputFolder::write(const std::string& name, std::string_view content) const {
    write_result(path_ / name, content);
}

}  // namespace downwash::cli
