#include "downwash/bench/saved_copy.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "downwash/bench/campaign_checksums.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/bench/machine.hpp"

namespace downwash::bench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& place) {
    throw CampaignError(place.string() + " cannot be written: " + std::generic_category().message(errno));
}

/// A file that is open for reading or writing.
class OpenFile {
 public:
    OpenFile(const fs::path& path, int flags) : descriptor_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    ~OpenFile() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    /// Whether everything is on the disk and the file is closed.
    bool finish() {
        const bool is_synced = fsync(descriptor_) == 0;
        return close(std::exchange(descriptor_, -1)) == 0 && is_synced;
    }

 private:
    int descriptor_;
};

bool write_all(int descriptor, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t written = write(descriptor, bytes, count);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return false;
        }
        bytes += written;
        count -= static_cast<std::size_t>(written);
    }
    return true;
}

bool copy_bytes(const OpenFile& from, const OpenFile& to) {
    std::array<char, 1U << 16U> buffer{};
    for (;;) {
        const ssize_t count = read(from.descriptor(), buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return count == 0;
        }
        if (!write_all(to.descriptor(), buffer.data(), static_cast<std::size_t>(count))) {
            return false;
        }
    }
}

/// A name beside a place that no other process on any node uses.
fs::path part_of(const fs::path& place) {
    return place.string() + "." + host_name() + "." + std::to_string(getpid()) + ".part";
}

/// What a file of results says of itself.
struct Stored {
    std::string settings;  ///< their checksum
    std::optional<std::uint64_t> shard;
    std::uint64_t runs = 0;
};

/// Nothing where there are no runs yet. @throws CampaignError, DatabaseError of what cannot be read
std::optional<Stored> stored_in(const fs::path& folder) {
    const fs::path file = folder / results_file;
    std::error_code unknown;
    if (!fs::exists(file, unknown)) {
        return std::nullopt;
    }
    const Database database(file);
    if (is_new(database)) {
        return std::nullopt;
    }
    require_layout(database, file);
    const std::uint64_t runs = database.number("SELECT finished_runs FROM campaign_checksum");
    if (runs == 0) {
        return std::nullopt;
    }
    return Stored{stored_plan_checksum(database), shard_number(database), runs};
}

void require_the_same(const Stored& copy, const fs::path& folder, const std::string& settings,
                      const std::optional<std::uint64_t>& shard) {
    if (copy.settings != settings || copy.shard != shard) {
        throw CampaignError((folder / results_file).string() +
                            " holds runs of another campaign, of other settings or of another shard: choose another "
                            "folder with --save");
    }
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder)) {
        throw CampaignError(folder.string() +
                            " cannot be made a folder: " + (error ? error.message() : "it is a file"));
    }
}

}  // namespace

void move_into_place(const fs::path& part, const fs::path& place) {
    OpenFile file(part, O_RDWR);
    if (file.descriptor() < 0 || !file.finish() || std::rename(part.c_str(), place.c_str()) != 0) {
        fail(place);
    }
}

void copy_whole(const fs::path& from, const fs::path& to) {
    const fs::path part = part_of(to);
    try {
        const OpenFile source(from, O_RDONLY);
        OpenFile copy(part, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW);
        if (source.descriptor() < 0 || copy.descriptor() < 0 || !copy_bytes(source, copy) || !copy.finish() ||
            std::rename(part.c_str(), to.c_str()) != 0) {
            fail(to);
        }
    } catch (...) {
        unlink(part.c_str());
        throw;
    }
}

SavedCopy::SavedCopy(fs::path results, fs::path saved) : results_(std::move(results)), saved_(std::move(saved)) {
    if (!saved_.empty()) {
        make_folder(saved_);
    }
}

void SavedCopy::restore(const CampaignPlan& plan, std::optional<std::uint64_t> shard, bool resumes) const {
    const std::optional<Stored> copy = saved_.empty() ? std::nullopt : stored_in(saved_);
    if (!copy) {
        return;
    }
    if (!resumes) {
        throw CampaignError((saved_ / results_file).string() + " holds runs already; --resume continues with them");
    }
    require_the_same(*copy, saved_, checksum_of(plan), shard);
    std::optional<Stored> results;
    try {
        results = stored_in(results_);
    } catch (const DatabaseError&) {  // damaged: the copy takes their place
    }
    if (!results || copy->runs > results->runs) {
        const CampaignLock lock(results_);
        std::error_code ignored;  // a journal would be that of another file then
        fs::remove(results_ / (std::string(results_file) + "-journal"), ignored);
        copy_whole(saved_ / results_file, results_ / results_file);
    }
}

void SavedCopy::save() {
    last_ = Clock::now();
    if (saved_.empty()) {
        return;
    }
    const std::optional<Stored> results = stored_in(results_);
    const std::optional<Stored> copy = stored_in(saved_);
    if (results && copy) {
        require_the_same(*copy, saved_, results->settings, results->shard);
    }
    if (results && (!copy || copy->runs <= results->runs)) {
        copy_whole(results_ / results_file, saved_ / results_file);
    }
}

void SavedCopy::save_now_and_then() {
    constexpr std::chrono::minutes period{2};
    if (!saved_.empty() && Clock::now() - last_ > period) {
        save_if_possible();
    }
}

void SavedCopy::save_if_possible() {
    try {
        save();
    } catch (const std::runtime_error&) {  // the disk of the copy may come back
    }
}

}  // namespace downwash::bench
