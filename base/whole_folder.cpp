#include "downwash/base/whole_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <random>
#include <system_error>

#include "downwash/base/files.hpp"

namespace downwash {
namespace {

namespace fs = std::filesystem;

/// Names of hidden folders go on with the process and a random number: ".NAME.new-1234-567".
constexpr char new_mark[] = ".new-";  ///< a folder that has not appeared yet, or that another one replaced
constexpr char old_mark[] = ".old-";  ///< a folder that was moved aside: its place is empty for a moment

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
    throw FolderError(path.string() + " cannot be written: " + reason);
}

std::string last_reason() {
    return std::generic_category().message(errno);
}

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

fs::path resolved(const fs::path& place) {
    std::error_code error;
    fs::path path = fs::weakly_canonical(place.has_filename() ? place : place.parent_path(), error);
    path = fs::absolute(error ? place : path, error).lexically_normal();
    return path.has_filename() || !path.has_relative_path() ? path : path.parent_path();
}

fs::path hidden(const fs::path& folder, const fs::path& place, const char* mark) {
    std::random_device random;
    return folder /
           ("." + place.filename().string() + mark + std::to_string(getpid()) + "-" + std::to_string(random()));
}

/// The process in the name of a hidden folder of this place; nothing if it is not one.
std::optional<std::string> process_in(const std::string& name, const fs::path& place, const char* mark) {
    const std::string begin = "." + place.filename().string() + mark;
    const std::size_t dash = name.rfind('-');
    const auto is_number = [](const std::string& text) {
        return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    };
    if (!name.starts_with(begin) || dash < begin.size() || !is_number(name.substr(dash + 1))) {
        return std::nullopt;
    }
    const std::string process = name.substr(begin.size(), dash - begin.size());
    return is_number(process) ? std::optional(process) : std::nullopt;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        entries.push_back(at->path());
    }
    return entries;
}

/// Removes a folder of files. What is in a folder below stays, and so does the folder then.
void remove_folder(const fs::path& folder) {
    for (const fs::path& entry : entries_of(folder)) {
        unlink(entry.c_str());
    }
    rmdir(folder.c_str());
}

void sync(const fs::path& folder) {
    if (const OpenFolder opened(folder); opened.is_open()) {
        fsync(opened.descriptor());  // some file systems cannot; there is nothing else to try
    }
}

/// Lets two folders change places. Not every file system can.
bool exchange(const fs::path& one, const fs::path& other) {
#ifdef RENAME_EXCHANGE
    return renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
#else
    return false;
#endif
}

/// Replaces a folder in two steps, where one does not work; at the end, the folder from `place` is called `aside`.
bool replace(const fs::path& place, const fs::path& by, const fs::path& aside) {
    if (std::rename(place.c_str(), aside.c_str()) != 0) {
        return false;
    }
    if (std::rename(by.c_str(), place.c_str()) != 0) {
        std::rename(aside.c_str(), place.c_str());
        return false;
    }
    return true;
}

/// Whether programs that stand in a folder would find themselves outside after a move of it, this one above all.
bool is_current_folder(const fs::path& folder) {
    std::error_code error;
    const fs::path current = fs::current_path(error);
    return std::mismatch(folder.begin(), folder.end(), current.begin(), current.end()).first == folder.end();
}

/// Makes a new folder like one that is there: with the same owner, group and permissions.
bool resemble(const OpenFolder& made, const fs::path& like) {
    struct stat status {};
    return stat(like.c_str(), &status) == 0 && status.st_uid == geteuid() &&
           fchown(made.descriptor(), status.st_uid, status.st_gid) == 0 &&
           fchmod(made.descriptor(), status.st_mode & 07777U) == 0;
}

/// Makes a hidden folder and locks it.
OpenFolder claimed(const fs::path& folder) {
    OpenFolder made;
    if (mkdir(folder.c_str(), 0777) == 0) {
        made = OpenFolder(folder);
        flock(made.descriptor(), LOCK_EX | LOCK_NB);
    }
    return made;
}

}  // namespace

OpenFolder::OpenFolder(const fs::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {}

OpenFolder::~OpenFolder() {
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

FolderLock::FolderLock(const fs::path& place) {
    const fs::path path = resolved(place);
    folder_ = OpenFolder(path.parent_path());
    if (!folder_.is_open()) {
        folder_ = OpenFolder(path);
    }
    while (flock(folder_.descriptor(), LOCK_EX) != 0 && errno == EINTR) {
    }
}

WholeFolder::WholeFolder(fs::path place, std::vector<std::string> names)
    : shown_(std::move(place)), place_(resolved(shown_)), names_(std::move(names)) {
    std::error_code error;
    fs::create_directories(place_.parent_path(), error);
    if (error) {
        fail(shown_, error.message());
    }
    const FolderLock lock(place_);
    clear_leftovers();
    require_usable();
    stage();
}

WholeFolder::~WholeFolder() {
    if (!staged_.empty()) {
        remove_folder(staged_);
    }
}

void WholeFolder::require_usable() const {
    if (!is_there(place_)) {
        return;
    }
    std::error_code ignored;
    if (!fs::is_directory(place_, ignored)) {
        fail(shown_, "it is a file, expected a folder");
    }
    if (faccessat(AT_FDCWD, place_.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
        fail(shown_, last_reason());
    }
    for (const std::string& name : names_) {
        if (fs::is_directory(fs::symlink_status(place_ / name, ignored))) {
            fail(shown_ / name, "it is a folder, expected a file");
        }
    }
}

/// @throws FolderError if one is not left over but in use
void WholeFolder::clear_leftovers() const {
    std::vector<fs::path> all = entries_of(place_.parent_path());
    const std::vector<fs::path> inside = entries_of(place_);
    all.insert(all.end(), inside.begin(), inside.end());
    for (const fs::path& path : all) {
        const std::string name = path.filename().string();
        const auto made_by = process_in(name, place_, new_mark);
        const auto moved_by = process_in(name, place_, old_mark);
        const OpenFolder folder = made_by || moved_by ? OpenFolder(path) : OpenFolder();
        if (!folder.is_open()) {
            continue;
        }
        if (flock(folder.descriptor(), LOCK_EX | LOCK_NB) != 0) {
            if (errno == EWOULDBLOCK) {
                fail(shown_, "process " + (made_by ? *made_by : *moved_by) + " is about to write its results there");
            }
            continue;  // without locks nobody knows whether it is in use
        }
        if (moved_by && !is_there(place_)) {
            std::rename(path.c_str(), place_.c_str());
        } else {
            remove_folder(path);
        }
    }
}

void WholeFolder::stage() {
    const bool is_old = is_there(place_);
    if (place_.has_filename() && !(is_old && is_current_folder(place_))) {
        staged_ = hidden(place_.parent_path(), place_, new_mark);
        claim_ = claimed(staged_);
        is_beside_ = claim_.is_open() && (!is_old || resemble(claim_, place_));
    }
    if (is_old && !claim_.is_open()) {
        staged_ = hidden(place_, place_, new_mark);
        claim_ = claimed(staged_);
    }
    if (!claim_.is_open()) {
        const std::string reason = last_reason();
        staged_.clear();
        fail(shown_, reason);
    }
}

void WholeFolder::write_into(const fs::path& folder, const std::string& name, const std::string& content) const {
    try {
        write_file(folder / name, content);
    } catch (const FileError& error) {
        throw FolderError((shown_ / name).string() + " " + error.what());
    }
}

void WholeFolder::write(const Files& files) {
    for (const auto& [name, content] : files) {
        write_into(staged_, name, content);
    }
    sync(staged_);
    const FolderLock lock(place_);
    if (!appear()) {
        replace_files(files);
    }
    sync(place_.parent_path());
    remove_folder(staged_);  // by now the one of before
    staged_.clear();
    claim_ = {};
}

/// Moves the staged folder to its place; false if that cannot be and nothing is changed.
bool WholeFolder::appear() {
    if (!is_beside_) {
        return false;
    }
    if (!is_there(place_)) {
        if (std::rename(staged_.c_str(), place_.c_str()) != 0) {
            fail(shown_, last_reason());
        }
        return true;
    }
    if (!keep_other_files(place_, staged_)) {
        return false;
    }
    if (!exchange(staged_, place_)) {
        const fs::path aside = hidden(place_.parent_path(), place_, old_mark);
        if (!replace(place_, staged_, aside)) {
            return false;
        }
        staged_ = aside;
    }
    keep_other_files(staged_, place_);  // what somebody added meanwhile
    return true;
}

/// Gives every file that is none of ours a second name in another folder, unless there is one.
bool WholeFolder::keep_other_files(const fs::path& from, const fs::path& to) const {
    const std::vector<fs::path> entries = entries_of(from);
    return std::all_of(entries.begin(), entries.end(), [&](const fs::path& entry) {
        const bool is_ours = std::find(names_.begin(), names_.end(), entry.filename()) != names_.end();
        return is_ours || linkat(AT_FDCWD, entry.c_str(), AT_FDCWD, (to / entry.filename()).c_str(), 0) == 0 ||
               errno == EEXIST;
    });
}

void WholeFolder::replace_files(const Files& files) const {
    const auto remove = [this](const std::string& name) {
        if (unlink((place_ / name).c_str()) != 0 && errno != ENOENT) {
            fail(shown_ / name, last_reason());
        }
    };
    remove(files.back().first);
    sync(place_);
    std::for_each(names_.begin(), names_.end(), remove);
    for (const auto& [name, content] : files) {
        if (std::rename((staged_ / name).c_str(), (place_ / name).c_str()) != 0) {
            write_into(place_, name, content);  // beyond a mount point
        }
    }
    sync(place_);
}

}  // namespace downwash
