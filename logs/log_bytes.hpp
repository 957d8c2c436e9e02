#pragma once

// Private to logs/.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace downwash::logs {

/// The bytes of a binary log from its beginning to its end, a little at a time: a log of any length takes the same
/// memory.
class LogBytes {
 public:
    /// @throws InputError if it is no file that can be read
    explicit LogBytes(const std::filesystem::path& file);
    /// Bytes that are in memory. @param bytes must outlive this
    LogBytes(std::string_view bytes, std::string name) : name_(std::move(name)), held_(bytes), size_(bytes.size()) {}

    /// The next bytes, so many or all that are left. Valid until the next call.
    [[nodiscard]] std::string_view peek(std::size_t count);
    /// Goes on behind so many bytes, or at the end.
    void skip(std::uint64_t count);
    /// How many bytes are left.
    [[nodiscard]] std::uint64_t left() const noexcept { return size_ - offset_; }
    /// How many bytes are behind.
    [[nodiscard]] std::uint64_t offset() const noexcept { return offset_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }

    /// @throws InputError "NAME: byte 84: message", the first byte being 0
    [[noreturn]] void fail_at(std::uint64_t byte, const std::string& message) const;

 private:
    std::string name_;
    std::ifstream stream_;
    std::string buffer_;
    std::string_view held_;  ///< what is read and not behind
    std::uint64_t offset_ = 0, size_ = 0;
};

}  // namespace downwash::logs
