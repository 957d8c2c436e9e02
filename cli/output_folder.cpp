#include "downwash/cli/output_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
    throw UsageError("cannot write " + path.string() + ": " + why);
}

/// A file that is removed unless it was moved to its place.
class UnfinishedFile {
 public:
    explicit UnfinishedFile(const fs::path& place)
        : place_(place), path_(place.string() + "." + std::to_string(getpid()) + ".part") {
        descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (descriptor_ < 0) {
            refuse(place_, std::strerror(errno));
        }
    }
    ~UnfinishedFile() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
        if (!is_finished_) {
            unlink(path_.c_str());
        }
    }
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    void write(std::string_view content) const {
        while (!content.empty()) {
            const ssize_t count = ::write(descriptor_, content.data(), content.size());
            if (count < 0 && errno == EINTR) {
                continue;
            }
            if (count <= 0) {
                refuse(place_, std::strerror(errno));
            }
            content.remove_prefix(static_cast<std::size_t>(count));
        }
    }

    void finish() {
        // Some file systems report a full disk only when the file is closed.
        const bool is_closed = close(std::exchange(descriptor_, -1)) == 0;
        if (!is_closed || std::rename(path_.c_str(), place_.c_str()) != 0) {
            refuse(place_, std::strerror(errno));
        }
        is_finished_ = true;
    }

 private:
    fs::path place_;
    std::string path_;
    int descriptor_ = -1;
    bool is_finished_ = false;
};

}  // namespace

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (!fs::is_directory(path_)) {
        throw UsageError("--out " + path_.string() +
                         " cannot be made a folder: " + (error ? error.message() : "it is not one"));
    }
    try {
        const UnfinishedFile trial(path_ / "solution.json");
    } catch (const UsageError& fault) {
        throw UsageError(std::string(fault.what()) + "; choose another folder with --out");
    }
}

void OutputFolder::write(const std::string& name, std::string_view content) const {
    UnfinishedFile file(path_ / name);
    file.write(content);
    file.finish();
}

}  // namespace downwash::cli
