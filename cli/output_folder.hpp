#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace downwash::cli {

/// Writes a file that the user has named, whole or not at all. @throws UsageError when that fails
void write_result(const std::filesystem::path& file, std::string_view content);

/// Where the results of a command go. Files in it appear whole or not at all.
class OutputFolder {
 public:
    /// Makes the folder and tries whether files can be written there.
    /// @throws UsageError when they cannot
    explicit OutputFolder(std::filesystem::path path);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    /// Writes a file beside its place and moves it there.
    /// @throws UsageError when that fails; nothing is left behind then
    void write(const std::string& name, std::string_view content) const;

 private:
    std::filesystem::path path_;
};

}  // namespace downwash::cli
