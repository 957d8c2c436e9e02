#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "downwash/mavlink/frame.hpp"

using namespace downwash::mavlink;

namespace {

std::string bytes_of_numbers(std::initializer_list<int> numbers) {
    std::string bytes;
    for (const int number : numbers) {
        bytes += static_cast<char>(number);
    }
    return bytes;
}

// Frames that other implementations of MAVLink publish in their tests (mavlink/rust-mavlink, v2_encode_decode_tests).
const std::string heartbeat_of_component_1 =
    bytes_of_numbers({0xfd, 9, 0, 0, 0xef, 1, 1, 0, 0, 0, 5, 0, 0, 0, 2, 3, 0x59, 3, 3, 16, 240});
const std::string heartbeat_of_component_2 =
    bytes_of_numbers({0xfd, 9, 0, 0, 0xef, 1, 2, 0, 0, 0, 5, 0, 0, 0, 2, 3, 0x59, 3, 3, 46, 115});
const std::string cut_command =
    bytes_of_numbers({0xfd, 30, 0, 0, 0, 0, 50, 76, 0, 0, 0, 0, 230, 66, 0, 64, 156, 69,  0, 0,   0,
                      0,    0,  0, 0, 0, 0, 0,  0,  0, 0, 0, 0, 0,   0,  0, 0,  0,   255, 1, 188, 195});

Heartbeat published_heartbeat() {
    Heartbeat heartbeat;
    heartbeat.custom_mode = 5;
    heartbeat.type = 2;
    heartbeat.autopilot = 3;
    heartbeat.base_mode = 0x59;
    heartbeat.system_status = 3;
    return heartbeat;
}

LocalPositionNed numbered(std::uint32_t time_ms) {
    LocalPositionNed position;
    position.time_boot_ms = time_ms;
    position.x = 1.5F;
    return position;
}

std::vector<std::uint32_t> times_of(const std::vector<Frame>& frames) {
    std::vector<std::uint32_t> times;
    for (const Frame& frame : frames) {
        times.push_back(message_in<LocalPositionNed>(frame).value().time_boot_ms);
    }
    return times;
}

}  // namespace

TEST_CASE("frames have the bytes that other implementations publish") {
    const std::string payload = payload_of(published_heartbeat());
    CHECK(bytes_of({0xef, 1, 1, Heartbeat::id, payload}, crc_extra<Heartbeat>()) == heartbeat_of_component_1);
    CHECK(bytes_of({0xef, 1, 2, Heartbeat::id, payload}, crc_extra<Heartbeat>()) == heartbeat_of_component_2);
    CommandLong command;
    command.param1 = 115;
    command.param2 = 5000;
    command.command = 511;  // MAV_CMD_SET_MESSAGE_INTERVAL
    CHECK(bytes_of({0, 0, 50, CommandLong::id, payload_of(command)}, crc_extra<CommandLong>()) == cut_command);
}

TEST_CASE("published frames are read") {
    const auto frames = FrameReader().take(heartbeat_of_component_2 + cut_command);
    REQUIRE(frames.size() == 2);
    CHECK(int{frames[0].sequence} == 239);
    CHECK(int{frames[0].system_id} == 1);
    CHECK(int{frames[0].component_id} == 2);
    CHECK(message_in<Heartbeat>(frames[0]).value().base_mode == 0x59);
    CHECK_FALSE(message_in<CommandLong>(frames[0]));
    const auto command = message_in<CommandLong>(frames[1]).value();
    CHECK(command.command == 511);
    CHECK(command.param1 == 115);
    CHECK(command.param2 == 5000);
    CHECK(command.param7 == 0);
}

TEST_CASE("a payload of zeros keeps its first byte") {
    const std::string bytes =
        bytes_of({1, 2, 3, LocalPositionNed::id, payload_of(LocalPositionNed{})}, crc_extra<LocalPositionNed>());
    CHECK(bytes.size() == 10 + 1 + 2);
    REQUIRE(FrameReader().take(bytes).size() == 1);
    CHECK(message_in<LocalPositionNed>(FrameReader().take(bytes)[0]).value().vz == 0);
}

TEST_CASE("a writer counts its frames from 0 to 255 and again") {
    FrameWriter writer(9, 191);
    std::string bytes;
    for (std::uint32_t i = 0; i < 257; ++i) {
        bytes += writer.frame(numbered(i));
    }
    const auto frames = FrameReader().take(bytes);
    REQUIRE(frames.size() == 257);
    CHECK(int{frames[255].sequence} == 255);
    CHECK(int{frames[256].sequence} == 0);
    CHECK(int{frames[0].system_id} == 9);
    CHECK(int{frames[0].component_id} == 191);
    CHECK(times_of(frames).back() == 256);
}

TEST_CASE("a stream that comes byte by byte gives the same frames") {
    FrameWriter writer(1, 1);
    FrameReader reader;
    std::vector<Frame> frames;
    for (const char byte : "garbage" + writer.frame(numbered(1)) + writer.frame(numbered(2))) {
        for (Frame& frame : reader.take({&byte, 1})) {
            frames.push_back(frame);
        }
    }
    CHECK(times_of(frames) == std::vector<std::uint32_t>{1, 2});
    CHECK(reader.skipped() == 7);
}

TEST_CASE("signed frames are read without a look at their signature") {
    Frame frame{1, 1, 1, Heartbeat::id, payload_of(published_heartbeat())};
    std::string bytes = bytes_of(frame, crc_extra<Heartbeat>());
    bytes[2] = 1;
    const char extra = static_cast<char>(crc_extra<Heartbeat>());
    const std::uint16_t sum = checksum({&extra, 1}, checksum(bytes.substr(1, bytes.size() - 3)));
    bytes[bytes.size() - 2] = static_cast<char>(sum);
    bytes[bytes.size() - 1] = static_cast<char>(sum >> 8U);
    FrameReader reader;
    CHECK(reader.take(bytes + "twelve bytes").empty());
    CHECK(reader.take("!" + heartbeat_of_component_1).size() == 2);
    CHECK(reader.skipped() == 0);
}

TEST_CASE("what is no frame is skipped, and the next frame is read") {
    const std::string good = FrameWriter(1, 1).frame(numbered(7));
    std::string wrong_sum = good, unknown = good, flagged = good, first_version = good;
    wrong_sum.back() = static_cast<char>(wrong_sum.back() + 1);
    unknown[7] = 77 + 1;
    flagged[2] = 2;
    first_version[0] = static_cast<char>(0xfe);
    for (const std::string& bad :
         {wrong_sum, unknown, flagged, first_version, good.substr(0, good.size() - 1), good.substr(1),
          std::string(300, static_cast<char>(0xfd)), std::string("\0\xff", 2)}) {
        FrameReader reader;
        // A start of frame may ask for up to 280 bytes before its checksum tells that it is none.
        const auto frames = reader.take(bad + good + std::string(300, ' '));
        CHECK(times_of(frames) == std::vector<std::uint32_t>{7});
        CHECK(reader.skipped() == bad.size() + 300);
    }
}

TEST_CASE("no bytes break the reader, and it invents no frame") {
    std::mt19937 random(5);
    std::string written;
    FrameWriter writer(1, 1);
    for (std::uint32_t i = 0; i < 200; ++i) {
        written += writer.frame(numbered(i));
    }
    std::size_t kept = 0;
    for (int damage = 0; damage < 200; ++damage) {
        std::string bytes = written;
        for (int change = 0; change < 40; ++change) {
            const std::size_t place = random() % bytes.size();
            switch (random() % 3) {
                case 0:
                    bytes[place] = static_cast<char>(random());
                    break;
                case 1:
                    bytes.erase(place, random() % 60);
                    break;
                default:
                    bytes.insert(place, random() % 60, static_cast<char>(random() % 2 == 0 ? 0xfd : random()));
            }
        }
        FrameReader reader;
        std::vector<Frame> frames;
        for (std::size_t place = 0; place < bytes.size();) {
            const std::size_t length = std::min<std::size_t>(random() % 100, bytes.size() - place);
            for (Frame& frame : reader.take(std::string_view(bytes).substr(place, length))) {
                frames.push_back(frame);
            }
            place += length;
        }
        for (const Frame& frame : frames) {
            REQUIRE(message_in<LocalPositionNed>(frame).value().x == 1.5F);
            REQUIRE(message_in<LocalPositionNed>(frame).value().time_boot_ms == frame.sequence);
        }
        kept += frames.size();
    }
    // Each of 40 changes costs two or three frames of 200 at most.
    CHECK(kept > 200 * 80);
}
