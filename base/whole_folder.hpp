#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// A folder cannot be written; what() names the file or folder, and the reason.
struct DOWNWASH_EXPORT FolderError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An open directory or nothing; closed at the end.
class DOWNWASH_EXPORT OpenFolder {
 public:
    OpenFolder() = default;
    explicit OpenFolder(const std::filesystem::path& folder);
    ~OpenFolder();
    OpenFolder(OpenFolder&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    OpenFolder& operator=(OpenFolder&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }

    [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
    int descriptor_ = -1;
};

/// While it lives, no WholeFolder appears in this place, and nobody else has such a lock. Waits for its turn. For
/// moments only: to write files beside those that are there. On file systems without locks it does nothing.
class DOWNWASH_EXPORT FolderLock {
 public:
    explicit FolderLock(const std::filesystem::path& place);

 private:
    OpenFolder folder_;
};

/// A folder of files that belong together. It is written beside its place, under a hidden name, and appears there as
/// one: whoever looks into it, also after a kill or a loss of power, finds all files of before or all new ones.
///
/// Files with other names that are in the folder stay. If the folder cannot be moved, its files are replaced one by
/// one: the current folder, a mount point, a folder of another user or with folders in it. The last file of a list is
/// then removed first and put last, so that a kill leaves a folder without it.
class DOWNWASH_EXPORT WholeFolder {
 public:
    using Files = std::vector<std::pair<std::string, std::string>>;  ///< names and contents

    /// Claims the place for this process, until the end of this object or a kill, and removes what a killed process
    /// left.
    /// @param place which may be there already or not; folders above it are made   @param names of all files that such
    /// a folder can have; those that write() does not get disappear
    /// @throws FolderError if it cannot be written, or another process has claimed it
    WholeFolder(std::filesystem::path place, std::vector<std::string> names);
    ~WholeFolder();
    WholeFolder(const WholeFolder&) = delete;
    WholeFolder& operator=(const WholeFolder&) = delete;

    /// Puts the folder in its place, once. @pre every name is among those given before
    /// @throws FolderError if that fails; then the folder is as before, if it can be moved
    void write(const Files& files);

 private:
    void require_usable() const;
    void clear_leftovers() const;
    void stage();
    bool appear();
    bool keep_other_files(const std::filesystem::path& from, const std::filesystem::path& to) const;
    void replace_files(const Files& files) const;
    void write_into(const std::filesystem::path& folder, const std::string& name, const std::string& content) const;

    std::filesystem::path shown_;   ///< the place as it was given
    std::filesystem::path place_;   ///< absolute, without links
    std::filesystem::path staged_;  ///< the hidden folder
    std::vector<std::string> names_;
    OpenFolder claim_;  ///< the hidden folder, locked
    bool is_beside_ = false;
};

}  // namespace downwash
