#include "downwash/logs/log_bytes.hpp"

#include <algorithm>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash::logs {

LogBytes::LogBytes(const std::filesystem::path& file) : name_(file.string()) {
    static_cast<void>(naming(file, [&] { return read_file(file, 1); }));  // says what is wrong with it
    stream_.open(file, std::ios::binary | std::ios::ate);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(stream_.tellg(), 0));
    stream_.seekg(0);
}

std::string_view LogBytes::peek(std::size_t count) {
    constexpr std::size_t block = std::size_t{1} << 20U;
    if (held_.size() < count && stream_.is_open()) {
        std::string next(held_);
        const std::size_t kept = next.size();
        next.resize(kept + std::max(block, count));
        stream_.read(next.data() + kept, static_cast<std::streamsize>(next.size() - kept));
        next.resize(kept + static_cast<std::size_t>(stream_.gcount()));
        if (!stream_) {
            stream_.close();  // the end
        }
        buffer_ = std::move(next);
        held_ = buffer_;
    }
    return held_.substr(0, count);
}

void LogBytes::skip(std::uint64_t count) {
    count = std::min(count, left());
    if (count > held_.size() && stream_.is_open()) {
        stream_.seekg(static_cast<std::streamoff>(count - held_.size()), std::ios::cur);
        held_ = {};
    } else {
        held_.remove_prefix(static_cast<std::size_t>(std::min<std::uint64_t>(count, held_.size())));
    }
    offset_ += count;
}

void LogBytes::fail_at(std::uint64_t byte, const std::string& message) const {
    throw_input_error(name_ + ": byte " + std::to_string(byte) + ": " + message);
}

}  // namespace downwash::logs
