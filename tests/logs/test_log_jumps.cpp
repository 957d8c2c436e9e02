#include <catch2/catch.hpp>
#include <string>

#include "../support/error_of.hpp"
#include "written.hpp"

// Resets of estimators, as PX4 and ArduPilot log them and as places show them.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("A reset of PX4's estimator is a jump of the log, in axes with z up") {
    ULogWriter log;
    log.format(
        "vehicle_local_position:uint64_t timestamp;float x;float y;float z;float[2] delta_xy;float delta_z;"
        "uint8_t xy_reset_counter;uint8_t z_reset_counter;");
    log.format("vehicle_attitude:uint64_t timestamp;float[4] q;float[4] delta_q_reset;uint8_t quat_reset_counter;");
    log.subscribe(0, "vehicle_local_position");
    log.subscribe(1, "vehicle_attitude");
    for (int i = 0; i < 10; ++i) {
        const auto t = static_cast<std::uint64_t>(1'000'000 + 20'000 * i);
        const float x = i < 4 ? 1.F : 1.3F;
        Bytes place;
        place.add<std::uint64_t>(t).add<float>(x).add<float>(2).add<float>(-3);
        place.add<float>(i < 4 ? 0 : 0.3F).add<float>(i < 4 ? 0 : 0.4F).add<float>(i < 6 ? 0 : 0.2F);
        log.data(0, place.add<std::uint8_t>(i < 4 ? 255 : 0).add<std::uint8_t>(i < 6 ? 1 : 2).text);
        Bytes attitude;
        attitude.add<std::uint64_t>(t).add<float>(1).add<float>(0).add<float>(0).add<float>(0);
        attitude.add<float>(static_cast<float>(std::cos(0.1))).add<float>(0).add<float>(0);
        attitude.add<float>(static_cast<float>(std::sin(0.1))).add<std::uint8_t>(i < 8 ? 5 : 6);
        log.data(1, attitude.text);
    }
    const FlightLog read = WrittenLog(log.text).read();
    REQUIRE(read.jumps.size() == 3);
    CHECK(read.jumps[0].kind == JumpKind::position);
    CHECK(read.jumps[0].t_s == Approx(0.08));
    CHECK(read.jumps[0].step_m[0] == Approx(0.3));
    CHECK(read.jumps[0].step_m[1] == Approx(-0.4));
    CHECK(read.jumps[0].source == "vehicle_local_position.xy_reset_counter");
    CHECK(read.jumps[1].kind == JumpKind::height);
    CHECK(read.jumps[1].t_s == Approx(0.12));
    CHECK(read.jumps[1].step_m[2] == Approx(-0.2));
    CHECK(read.jumps[2].kind == JumpKind::heading);
    CHECK(read.jumps[2].turn_rad == Approx(-0.2));
}

TEST_CASE("A table of ulog2csv tells the same resets, and leaves out places that are not valid") {
    const FlightLog log = WrittenLog(
                              "timestamp,x,y,z,delta_xy[0],delta_xy[1],xy_valid,z_valid,xy_reset_counter\n"
                              "1000000,1,2,-3,0,0,1,1,4\n1020000,1,2,-3,0,0,0,1,4\n1040000,1.3,2.4,-3,0.3,0.4,1,1,5\n",
                              "track.csv")
                              .read();
    CHECK(log.recorded_axes == LogAxes::down);
    CHECK(log.position_m.rows() == 2);
    REQUIRE(log.jumps.size() == 1);
    CHECK(log.jumps[0].t_s == Approx(0.04));
    CHECK(log.jumps[0].step_m[1] == Approx(-0.4));
    REQUIRE(log.remarks.size() == 1);
    CHECK(log.remarks[0].starts_with("1 rows of track.csv"));
}

TEST_CASE("ArduPilot's events of its estimator are jumps, and a switch to another core is said") {
    DataFlashWriter log;
    log.format(65, 36, "XKF1", "QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD");
    log.format(70, 12, "EV", "QB", "TimeUS,Id");
    log.format(71, 13, "ERR", "QBB", "TimeUS,Subsys,ECode");
    for (int i = 0; i < 5; ++i) {
        const auto t = static_cast<std::uint64_t>(1'000'000 + 100'000 * i);
        log.message(65, Bytes().add<std::uint64_t>(t).add<std::uint8_t>(0).add_text("", 24).text);
        if (i == 1 || i == 3) {
            log.message(70, Bytes().add<std::uint64_t>(t).add<std::uint8_t>(i == 1 ? 10 : 62).text);
        }
        if (i == 2) {
            log.message(71, Bytes().add<std::uint64_t>(t).add<std::uint8_t>(24).add<std::uint8_t>(1).text);
        }
    }
    const FlightLog read = WrittenLog(log.text).read();
    REQUIRE(read.jumps.size() == 2);
    CHECK(read.jumps[0].kind == JumpKind::estimator);
    CHECK(read.jumps[0].t_s == Approx(0.2));
    CHECK(read.jumps[1].kind == JumpKind::heading);
    REQUIRE(read.remarks.size() == 1);
    CHECK(read.remarks[0].find("flies by core 1") != std::string::npos);
}

TEST_CASE("Places that leave their own velocity are a jump, unless so many do that the velocity is of something else") {
    const auto text_of = [](double velocity, double step) {
        std::string text = "t_s,x,y,z,vx,vy,vz\n";
        for (int i = 0; i < 100; ++i) {
            text += std::to_string(0.1 * i) + "," + std::to_string(0.2 * i + (i >= 50 ? step : 0)) + ",1,2," +
                    std::to_string(velocity) + ",0,0\n";
        }
        return text;
    };
    CHECK(WrittenLog(text_of(2, 0), "flight.csv").read().jumps.empty());
    const FlightLog log = WrittenLog(text_of(2, 0.5), "flight.csv").read();
    REQUIRE(log.jumps.size() == 1);
    CHECK(log.jumps[0].t_s == Approx(5));
    CHECK(log.jumps[0].step_m[0] == Approx(0.5));
    CHECK(WrittenLog(text_of(-2, 0.5), "flight.csv").read().jumps.empty());
}

TEST_CASE("Bags of ROS 2 and compressed files are errors with a remedy") {
    using namespace std::string_literals;
    for (const auto& [bytes, remedy] :
         {std::pair{"SQLite format 3\0 and more bytes"s, "rosbags-convert"},
          std::pair{"\x89MCAP0\r\n and more"s, "rosbags-convert"},
          std::pair{"\x28\xB5\x2F\xFD and more bytes"s, "unzstd"}, std::pair{"BZh9 and more bytes"s, "unpack it"}}) {
        CHECK(error_of([&bytes = bytes] { return WrittenLog(bytes).read(); }).find(remedy) != std::string::npos);
    }
}
