#include "downwash/mavlink/frame.hpp"

#include <algorithm>
#include <cassert>

namespace downwash::mavlink {
namespace {

constexpr char start_of_frame = static_cast<char>(0xfd);
constexpr std::size_t header_length = 10, checksum_length = 2, signature_length = 13;
constexpr unsigned is_signed = 1;  // of the flags that a reader has to understand

unsigned byte_at(std::string_view bytes, std::size_t place) {
    return static_cast<unsigned char>(bytes[place]);
}

template <class... Known>
std::optional<std::uint8_t> crc_extra_of(std::uint32_t id, const std::tuple<Known...>* /*messages*/) {
    std::optional<std::uint8_t> extra;
    ((extra = id == Known::id ? crc_extra<Known>() : extra), ...);
    return extra;
}

/// What begins at a start of frame.
struct Begun {
    enum { no_frame, incomplete, complete } kind = no_frame;
    std::size_t length = 0;
    Frame frame = {};
};

Begun frame_at_start(std::string_view bytes) {
    if (bytes.size() < header_length) {
        return {Begun::incomplete};
    }
    const unsigned flags = byte_at(bytes, 2);
    const std::uint32_t id = byte_at(bytes, 7) | byte_at(bytes, 8) << 8U | byte_at(bytes, 9) << 16U;
    const auto extra = crc_extra_of(id, static_cast<const Messages*>(nullptr));
    if ((flags & ~is_signed) != 0 || !extra) {
        return {};
    }
    const std::size_t checked = header_length + byte_at(bytes, 1);
    const std::size_t length = checked + checksum_length + (flags == is_signed ? signature_length : 0);
    if (bytes.size() < length) {
        return {Begun::incomplete};
    }
    const char last = static_cast<char>(*extra);
    const std::uint16_t sum = checksum({&last, 1}, checksum(bytes.substr(1, checked - 1)));
    if (number_at<std::uint16_t>(bytes.data() + checked) != sum) {
        return {};
    }
    return {Begun::complete,
            length,
            {static_cast<std::uint8_t>(byte_at(bytes, 4)), static_cast<std::uint8_t>(byte_at(bytes, 5)),
             static_cast<std::uint8_t>(byte_at(bytes, 6)), id,
             std::string(bytes.substr(header_length, checked - header_length))}};
}

}  // namespace

std::string bytes_of(const Frame& frame, std::uint8_t crc_extra) {
    assert(frame.payload.size() <= max_payload && frame.message_id < 1U << 24U);
    const std::size_t last = frame.payload.find_last_not_of('\0');
    const std::string_view payload =
        std::string_view(frame.payload).substr(0, last == std::string::npos ? 1 : last + 1);
    std::string bytes{start_of_frame, static_cast<char>(payload.size()), 0, 0};
    for (const unsigned number : {unsigned{frame.sequence}, unsigned{frame.system_id}, unsigned{frame.component_id},
                                  frame.message_id, frame.message_id >> 8U, frame.message_id >> 16U}) {
        bytes += static_cast<char>(number);
    }
    bytes += payload;
    const char extra = static_cast<char>(crc_extra);
    append_little_endian(bytes, checksum({&extra, 1}, checksum(std::string_view(bytes).substr(1))));
    return bytes;
}

std::vector<Frame> FrameReader::take(std::string_view bytes) {
    left_ += bytes;
    std::vector<Frame> frames;
    std::size_t place = 0;
    while (place < left_.size()) {
        const std::size_t start = std::min(left_.find(start_of_frame, place), left_.size());
        skipped_ += start - place;
        place = start;
        if (place == left_.size()) {
            break;
        }
        Begun begun = frame_at_start(std::string_view(left_).substr(place));
        if (begun.kind == Begun::incomplete) {
            break;
        }
        if (begun.kind == Begun::complete) {
            frames.push_back(std::move(begun.frame));
            place += begun.length;
        } else {
            ++place;
            ++skipped_;
        }
    }
    left_.erase(0, place);
    return frames;
}

}  // namespace downwash::mavlink
