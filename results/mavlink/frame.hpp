#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/mavlink/messages.hpp"

namespace downwash::mavlink {

/// What a frame carries (https://mavlink.io/en/guide/serialization.html).
struct Frame {
    std::uint8_t sequence = 0;  ///< counts the frames of a sender, from 0 again after 255
    std::uint8_t system_id = 1;
    std::uint8_t component_id = 1;
    std::uint32_t message_id = 0;  ///< 24 bits
    std::string payload;           ///< at most max_payload bytes; zeros at its end may be missing
};

/// The bytes of a frame, without the zeros at the end of its payload but for the first byte. @param crc_extra of its
/// message
[[nodiscard]] DOWNWASH_EXPORT std::string bytes_of(const Frame& frame, std::uint8_t crc_extra);

/// The message in a frame; nothing if it is another one.
template <class Message>
[[nodiscard]] std::optional<Message> message_in(const Frame& frame) {
    return frame.message_id == Message::id ? std::optional(message_of<Message>(frame.payload)) : std::nullopt;
}

/// Makes the frames of one component, and counts them.
class FrameWriter {
 public:
    FrameWriter(std::uint8_t system_id, std::uint8_t component_id) noexcept
        : system_id_(system_id), component_id_(component_id) {}

    /// The bytes of the next frame.
    template <class Message>
    [[nodiscard]] std::string frame(const Message& message) {
        return bytes_of({sequence_++, system_id_, component_id_, Message::id, payload_of(message)},
                        crc_extra<Message>());
    }

 private:
    std::uint8_t system_id_, component_id_;
    std::uint8_t sequence_ = 0;
};

/// Finds frames of known messages among bytes. All other bytes are skipped: garbage, cut frames, wrong checksums,
/// unknown messages, frames of MAVLink 1 and those with flags that are not known. Signatures are not checked.
class DOWNWASH_EXPORT FrameReader {
 public:
    /// The frames that are complete with these bytes, in their order. What may be the beginning of a frame is kept for
    /// the next call. Make a reader for each datagram, and keep one for a stream.
    [[nodiscard]] std::vector<Frame> take(std::string_view bytes);

    /// Bytes that were no part of a frame, so far.
    [[nodiscard]] std::size_t skipped() const noexcept { return skipped_; }

 private:
    std::string left_;
    std::size_t skipped_ = 0;
};

}  // namespace downwash::mavlink
