#include "downwash/base/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <random>
#include <string>
#include <system_error>
#include <utility>

namespace downwash {
namespace {

namespace fs = std::filesystem;

std::string last_reason() {
    return std::generic_category().message(errno);
}

/// The file at the end of a chain of symbolic links; the file itself if it is not a link.
fs::path target_of(fs::path file) {
    constexpr int max_links = 40;  // as on Linux
    std::error_code error;
    for (int i = 0; fs::is_symlink(file, error); ++i) {
        const fs::path target = fs::read_symlink(file, error);
        if (i == max_links || error) {
            throw FileError("cannot be written: too many symbolic links, or one that cannot be read");
        }
        file = file.parent_path() / target;  // an absolute target stands alone
    }
    return file;
}

/// A file that is removed unless it was moved to its place.
class UnfinishedFile {
 public:
    explicit UnfinishedFile(const fs::path& place) : place_(target_of(place)) {
        // A name that nobody can foresee and that is not there yet: others may write to the same folder.
        constexpr int most_tries = 100;
        std::random_device random;
        for (int i = 0; i < most_tries && descriptor_ < 0 && (i == 0 || errno == EEXIST); ++i) {
            path_ = place_.string() + "." + std::to_string(random()) + ".part";
            descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        }
        if (descriptor_ < 0) {
            fail();
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
                fail();
            }
            content.remove_prefix(static_cast<std::size_t>(count));
        }
    }

    void finish() {
        // Content reaches the disk before its name does: a loss of power leaves the old file or the whole new one.
        if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {  // pipes and the like cannot
            fail();
        }
        // Some file systems report a full disk only when the file is closed.
        const bool is_closed = close(std::exchange(descriptor_, -1)) == 0;
        if (!is_closed || std::rename(path_.c_str(), place_.c_str()) != 0) {
            fail();
        }
        is_finished_ = true;
    }

 private:
    [[noreturn]] static void fail() { throw FileError("cannot be written: " + last_reason()); }

    fs::path place_;
    std::string path_;
    int descriptor_ = -1;
    bool is_finished_ = false;
};

void require_regular(const fs::path& file) {
    std::error_code error;
    switch (fs::status(file, error).type()) {
        case fs::file_type::regular:
            return;
        case fs::file_type::not_found:
            throw FileError("cannot be read: there is no such file");
        case fs::file_type::directory:
            throw FileError("cannot be read: it is a directory, expected a file");
        case fs::file_type::none:
            throw FileError("cannot be read: " + error.message());
        default:
            throw FileError("cannot be read: expected an ordinary file");
    }
}

}  // namespace

std::string read_file(const fs::path& file, std::size_t max_bytes) {
    require_regular(file);
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) {
        throw FileError("cannot be read: " + last_reason());
    }
    const std::streamoff size = stream.tellg();
    stream.seekg(0);
    std::string bytes(std::min(max_bytes, static_cast<std::size_t>(std::max<std::streamoff>(size, 0))), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
        throw FileError("cannot be read to its end");
    }
    return bytes;
}

std::string read_whole_file(const fs::path& file, std::size_t max_bytes) {
    std::error_code unknown;  // of what is no regular file: read_file says so
    const std::uintmax_t size = fs::file_size(file, unknown);
    if (unknown || size <= max_bytes) {
        std::string bytes = read_file(file, max_bytes + 1);
        if (bytes.size() <= max_bytes) {
            return bytes;
        }
    }
    throw FileError("is larger than " + std::to_string(max_bytes >> 20U) + " MiB: expected a smaller file");
}

void write_file(const fs::path& file, std::string_view content) {
    UnfinishedFile unfinished(file);
    unfinished.write(content);
    unfinished.finish();
}

void require_writable(const fs::path& file) {
    const UnfinishedFile trial(file);
}

}  // namespace downwash
