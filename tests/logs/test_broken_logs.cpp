#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "written.hpp"

// A log that is not what it claims to be is an error with the byte at which that shows.

using namespace downwash;
using namespace downwash::test;

namespace {

/// The error of a log without the name of its file.
std::string error_in(const std::string& bytes, LogOptions options = {}) {
    const WrittenLog log(bytes);
    const std::string error = error_of([&] { return log.read(options); });
    const std::size_t place = error.find("flight.log: ");
    return place == std::string::npos ? error : error.substr(place + 12);
}

LogOptions as(LogFormat format) {
    LogOptions options;
    options.format = format;
    return options;
}

bool begins(const std::string& text, const std::string& with) {
    INFO(text);
    const bool does = text.starts_with(with);
    CHECK(does);
    return does;
}

/// The header, the flags and their heads.
constexpr std::size_t first_message = 16 + 3 + 40;

std::string ulog_with(char type, const std::string& body) {
    ULogWriter log;
    log.message(type, body);
    return log.text;
}

}  // namespace

TEST_CASE("A ULog that is damaged is an error at the message that shows it") {
    const std::string at = "byte " + std::to_string(first_message) + ": ";
    begins(error_in("ULog\x01\x12\x36 and more bytes", as(LogFormat::ulog)), "byte 0: is no ULog");
    begins(error_in(std::string("ULog\x01\x12\x35\x01", 8)), "byte 0: the header ends after 8 bytes");
    begins(error_in(ulog_with('F', "no colon")), at + "the format 'no colon' has no name");
    begins(error_in(ulog_with('F', "a:float;")), at + "the format of a has the field 'float'");
    begins(error_in(ulog_with('F', "a:float[0] x;")), at + "the format of a has the field 'float[0] x'");
    begins(error_in(ulog_with('F', "a:float[99999999999999999999] x;")), at + "the format of a has the field");
    begins(error_in(ulog_with('F', "a:float[4 x;")), at + "the format of a has the field");
    begins(error_in(ulog_with('A', std::string("\0\0\0unknown", 10))), at + "the subscription of 'unknown'");
    begins(error_in(ulog_with('A', std::string("\0\0", 2))), at + "a subscription of 2 bytes");
    begins(error_in(ulog_with('D', std::string("\x05\0 data", 7))), at + "there is data of the message 5");
    begins(error_in(ulog_with('D', "x")), at + "a message of data is 1 bytes");
    begins(error_in(ULogWriter(2).text), "byte 16: the log needs a reader of a later version");
}

TEST_CASE("Formats of a ULog that contain themselves, or multiply without end, are errors") {
    ULogWriter circle;
    circle.format("a:b inner;");
    circle.format("b:a inner;");
    circle.subscribe(0, "a");
    CHECK(error_in(circle.text).find("nested deeper") != std::string::npos);

    ULogWriter empty;
    std::string many = "f0:";
    empty.format(many);
    for (int i = 1; i <= 7; ++i) {
        many = "f" + std::to_string(i) + ":";
        for (int k = 0; k < 2000; ++k) {
            many += "f" + std::to_string(i - 1) + " n;";
        }
        empty.format(many);
    }
    empty.subscribe(0, "f7");
    CHECK(error_in(empty.text).find("more fields than a message can hold") != std::string::npos);

    ULogWriter large;
    large.format("pair:double[60000] a;");
    large.subscribe(0, "pair");
    CHECK(error_in(large.text).find("longer than a message can be") != std::string::npos);
}

TEST_CASE("Data that is shorter than its format is an error at its message") {
    ULogWriter log;
    log.format("vehicle_local_position:uint64_t timestamp;float x;float y;float z;");
    log.subscribe(4, "vehicle_local_position");
    const std::size_t at = log.text.size();
    log.data(4, std::string(19, 'x'));
    begins(error_in(log.text), "byte " + std::to_string(at) + ": a message of vehicle_local_position has 19 bytes");
}

TEST_CASE("A log that ends within a message is an error there, or is read up to there if that is allowed") {
    for (const bool is_ulog : {true, false}) {
        const std::string whole = is_ulog ? ulog_of(small_flight(), 10) : dataflash_of(small_flight(), 10);
        LogOptions allowing;
        allowing.allows_truncation = true;
        for (const std::size_t lost : {1U, 5U, 20U}) {
            const std::string cut = whole.substr(0, whole.size() - lost);
            const std::string error = error_in(cut);
            CHECK(error.starts_with("byte "));
            CHECK(error.find("the log ends within a message; --allow-truncated") != std::string::npos);
            const std::size_t at = std::stoul(error.substr(5));
            CHECK(at < cut.size());
            CHECK(at + 100 > cut.size());
            const FlightLog log = WrittenLog(cut).read(allowing);
            CHECK(log.position_m.rows() >= 100);
            REQUIRE_FALSE(log.remarks.empty());
            CHECK(log.remarks.front().starts_with("byte " + std::to_string(at)));
        }
    }
}

TEST_CASE("A DataFlash log that is damaged is an error at the message that shows it") {
    begins(error_in("\x95\xA3 nothing", as(LogFormat::dataflash)), "byte 0: is no DataFlash log");
    DataFlashWriter log;
    const std::string at = "byte " + std::to_string(log.text.size()) + ": ";
    begins(error_in(log.text + "\xA3\x94zz"), at + "no message begins here");
    begins(error_in(log.text + "\xA3\x95\x42zz"), at + "a message has the type 66");
    DataFlashWriter odd = log;
    odd.format(65, 12, "ODD", "QB?", "TimeUS,A,B");
    begins(error_in(odd.text), at + "the format of ODD is 'QB?', where '?' is no type");
    DataFlashWriter wrong = log;
    wrong.format(65, 2, "BAD", "QB", "TimeUS,A");
    begins(error_in(wrong.text), at + "messages of BAD are said to have 2 bytes, but the format 'QB' has 12");
    DataFlashWriter labels = log;
    labels.format(65, 12, "LAB", "QB", "TimeUS,A,B");
    begins(error_in(labels.text), at + "the format of LAB has more labels than types");
    DataFlashWriter format = log;
    format.format(128, 88, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    begins(error_in(format.text), at + "messages of FMT are said to have 88 bytes");
}

TEST_CASE("A bag that is damaged is an error at the record that shows it") {
    const std::string magic = "#ROSBAG V2.0\n";
    const auto record = [&](const std::string& header, const std::string& data) {
        return error_in(magic + BagWriter::record(header, data));
    };
    const auto field = &BagWriter::field;
    begins(error_in("#ROSBAG V1.2\n and more", as(LogFormat::rosbag)), "byte 0: is no bag of ROS 1");
    begins(error_in(magic + "\xff\xff\xff\xff"), "byte 13: the header of a record has 4294967295 bytes");
    begins(error_in(magic + std::string("\x08\0\0\0op", 6)), "byte 13: the log ends within a record");
    begins(record("abc", ""), "byte 13: a field of a header is longer than the header");
    begins(record(std::string("\x09\0\0\0op", 6), ""), "byte 13: a field of a header is longer than the header");
    begins(record(BagWriter::number(2) + "op", ""), "byte 13: a field of a header has no name");
    begins(record("", ""), "byte 13: a record does not say what it is");
    begins(record(field("op", "\x09"), ""), "byte 13: a record has the unknown op 9");
    begins(record(field("op", "\x07"), ""), "byte 13: the header of a record has no number conn");
    begins(record(field("op", "\x07") + field("conn", BagWriter::number(1)), ""),
           "byte 13: a connection names no topic");
    begins(record(field("op", "\x02") + field("conn", BagWriter::number(1)), ""),
           "byte 13: a message is of the connection 1, which no record describes");
    BagWriter packed("lz4");
    packed.connect(1, "/a", "nav_msgs/Odometry");
    CHECK(error_in(packed.text()).find("the chunk is compressed by lz4: `rosbag decompress`") != std::string::npos);
    BagWriter cut;
    cut.connect(1, "/a", "nav_msgs/Odometry");
    cut.message(1, 5, "too short");
    CHECK(error_in(cut.text()).find("a message of /a ends before its type nav_msgs/Odometry does") !=
          std::string::npos);
    const std::string whole = bag_of(small_flight());
    CHECK(error_in(whole.substr(0, whole.size() - 2000)).find("the log ends within a record") != std::string::npos);
}

TEST_CASE("A log without places says so") {
    CHECK(error_in(ULogWriter().text) == "there is no position in this log");
    CHECK(error_in(DataFlashWriter().text) == "there is no position in this log");
}

TEST_CASE("No cut and no changed byte of a log does more than an error") {
    LoggedFlight beginning = small_flight();
    beginning.resize(3);
    for (const std::string& whole : {ulog_of(beginning, 10), dataflash_of(beginning, 10), bag_of(beginning)}) {
        const LogOptions options = as(log_format_of(whole));
        std::size_t errors = 0;
        for (std::size_t i = 0; i < whole.size(); i += 3) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
            const WrittenLog log(damaged);
            errors += errors_of([&] { return log.read(options); }).empty() ? 0 : 1;
        }
        CHECK(errors > 20);
    }
}
