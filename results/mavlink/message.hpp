#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "downwash/base/byte_order.hpp"
#include "downwash/mavlink/checksum.hpp"

// What follows from the description of a message. A message has `id`, `name`, and `fields()`: its fields in the order
// of the wire (the widest numbers first, extensions last).

namespace downwash::mavlink {

/// The longest payload of any message.
inline constexpr std::size_t max_payload = 255;

/// A field of a message, with MAVLink's name of it.
template <class Message, class Number>
struct Field {
    std::string_view name;
    Number Message::*member;
    bool is_extension;
};

template <class Message, class Number>
[[nodiscard]] constexpr Field<Message, Number> field(std::string_view name, Number Message::*member) noexcept {
    return {name, member, false};
}

/// A field that was added to a message later. Older readers do not know it.
template <class Message, class Number>
[[nodiscard]] constexpr Field<Message, Number> extension(std::string_view name, Number Message::*member) noexcept {
    return {name, member, true};
}

/// MAVLink's name of a number's type.
template <class Number>
inline constexpr std::string_view type_name{};
template <>
inline constexpr std::string_view type_name<std::uint8_t> = "uint8_t";
template <>
inline constexpr std::string_view type_name<std::uint16_t> = "uint16_t";
template <>
inline constexpr std::string_view type_name<std::uint32_t> = "uint32_t";
template <>
inline constexpr std::string_view type_name<std::int32_t> = "int32_t";
template <>
inline constexpr std::string_view type_name<float> = "float";

/// The checksum of a field's type and name, after those before it.
template <class Message, class Number>
[[nodiscard]] constexpr std::uint16_t checksum(const Field<Message, Number>& field, std::uint16_t before) noexcept {
    static_assert(!type_name<Number>.empty(), "a type that no message here has yet");
    return field.is_extension ? before
                              : checksum(" ", checksum(field.name, checksum(" ", checksum(type_name<Number>, before))));
}

/// CRC_EXTRA of a message: two programs that do not mean the same fields do not read each other's frames.
template <class Message>
[[nodiscard]] constexpr std::uint8_t crc_extra() noexcept {
    constexpr unsigned bits = 8;
    std::uint16_t sum = checksum(" ", checksum(Message::name));
    std::apply([&](const auto&... fields) { ((sum = checksum(fields, sum)), ...); }, Message::fields());
    return static_cast<std::uint8_t>((sum & 0xffU) ^ (sum >> bits));
}

/// The payload of a message, whole.
template <class Message>
[[nodiscard]] std::string payload_of(const Message& message) {
    std::string bytes;
    std::apply([&](const auto&... fields) { (append_little_endian(bytes, message.*fields.member), ...); },
               Message::fields());
    return bytes;
}

/// The message of a payload. Zeros at its end may be missing, and it may end in fields that are not known here.
template <class Message>
[[nodiscard]] Message message_of(std::string_view payload) {
    std::string bytes(payload);
    bytes.resize(max_payload);
    Message message;
    std::size_t place = 0;
    const auto read = [&]<class Number>(const Field<Message, Number>& field) {
        message.*field.member = number_at<Number>(bytes.data() + place);
        place += sizeof(Number);
    };
    std::apply([&](const auto&... fields) { (read(fields), ...); }, Message::fields());
    return message;
}

}  // namespace downwash::mavlink
