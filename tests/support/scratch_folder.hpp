#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace downwash::test {

/// An empty folder that disappears with the test.
class ScratchFolder {
 public:
    explicit ScratchFolder(const std::filesystem::path& in = std::filesystem::temp_directory_path()) {
        std::string name = (in / "downwash-test-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
    std::filesystem::path path_;
};

}  // namespace downwash::test
