#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "downwash/mavlink/messages.hpp"

using namespace downwash::mavlink;

namespace {

/// A message each of whose numbers differs from the others.
template <class Message>
Message numbered() {
    Message message;
    int next = 1;
    const auto set = [&]<class Number>(const Field<Message, Number>& field) {
        message.*field.member = static_cast<Number>(next++);
    };
    std::apply([&](const auto&... fields) { (set(fields), ...); }, Message::fields());
    return message;
}

/// @param crc_extra and length of the whole payload, from the C library that MAVLink generates (c_library_v2, common)
template <class Message>
void check(std::uint8_t crc_extra_published, std::size_t length_published) {
    INFO(Message::name);
    CHECK(int{crc_extra<Message>()} == int{crc_extra_published});
    CHECK(payload_of(Message{}).size() == length_published);
    const Message message = numbered<Message>();
    const std::string payload = payload_of(message);
    const auto read = message_of<Message>(payload);
    const auto is_same = [&](const auto& field) { CHECK(read.*field.member == message.*field.member); };
    std::apply([&](const auto&... fields) { (is_same(fields), ...); }, Message::fields());
}

}  // namespace

TEST_CASE("the checksum is CRC-16/MCRF4XX") {
    // Check value of "CRC-16/MCRF4XX" in the Catalogue of parametrised CRC algorithms (reveng).
    static_assert(checksum("123456789") == 0x6f91);
    CHECK(checksum("") == 0xffff);
    CHECK(checksum("56789", checksum("1234")) == 0x6f91);
}

TEST_CASE("CRC_EXTRA and the length of each message follow from its fields as MAVLink publishes them") {
    check<Heartbeat>(50, 9);
    check<Attitude>(39, 28);
    check<LocalPositionNed>(185, 28);
    check<SetPositionTargetLocalNed>(143, 53);
    check<CommandLong>(152, 33);
    check<CommandAck>(143, 10);
}

TEST_CASE("numbers stand in the order of the wire, the lowest byte first") {
    SetPositionTargetLocalNed target;
    target.time_boot_ms = 0x01020304;
    target.x = 1;          // 0x3f800000
    target.yaw_rate = -2;  // 0xc0000000
    target.type_mask = 0x0c00;
    target.target_system = 7;
    const std::string payload = payload_of(target);
    CHECK(payload.substr(0, 8) == std::string("\x04\x03\x02\x01\x00\x00\x80\x3f", 8));
    CHECK(payload.substr(44) == std::string("\x00\x00\x00\xc0\x00\x0c\x07\x00\x01", 9));
}

TEST_CASE("a payload may be cut where zeros follow, and longer than what is known of its message") {
    Heartbeat heartbeat;
    heartbeat.custom_mode = 5;
    std::string payload = payload_of(heartbeat);
    CHECK(message_of<Heartbeat>(payload + "more").custom_mode == 5);
    CHECK(message_of<Heartbeat>(payload + "more").mavlink_version == 3);
    CHECK(message_of<Heartbeat>(payload.substr(0, 1)).custom_mode == 5);
    CHECK(message_of<Heartbeat>(payload.substr(0, 1)).mavlink_version == 0);
    CHECK(message_of<Heartbeat>("").custom_mode == 0);
    CHECK(message_of<Heartbeat>(std::string(max_payload, 'x')).system_status == 'x');
}

TEST_CASE("PX4's modes are those of its custom_mode") {
    CHECK(px4_offboard_mode == 0x00060000);
    CHECK(px4_hold_mode == 0x03040000);
}
