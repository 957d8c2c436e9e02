#include <catch2/catch.hpp>

#include "written.hpp"

// Logs of PX4 and ArduPilot hold what was written into them, in axes with z up.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Whether a log holds the small flight. @param angle how well it holds attitudes [rad]
void check_small_flight(const FlightLog& log, double start_s, double angle) {
    const LoggedFlight flight = small_flight();
    CHECK(log.recorded_axes == LogAxes::down);
    CHECK(log.axes_source == AxesSource::format);
    CHECK(log.start_s == Approx(start_s));
    CHECK(log.duration_s == Approx(2));
    REQUIRE(log.position_m.rows() == flight.size());
    REQUIRE(log.velocity_m_s.rows() == flight.size());
    REQUIRE(log.attitude.rows() == flight.size());
    REQUIRE(log.body_rates_rad_s.rows() == flight.size());
    for (std::size_t i = 0; i < flight.size(); i += 20) {
        const LoggedMoment& moment = flight[i];
        CHECK(log.position_m.t_s[i] == Approx(moment.t_s).margin(1e-9));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CHECK(log.position_m.row(i)[axis] == Approx(moment.position_m[axis]).margin(1e-6));
            CHECK(log.velocity_m_s.row(i)[axis] == Approx(moment.velocity_m_s[axis]).margin(1e-6));
            CHECK(log.body_rates_rad_s.row(i)[axis] == Approx(moment.body_rates_rad_s[axis]).margin(1e-6));
        }
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(log.attitude.row(i)[k] == Approx(moment.attitude[k]).margin(angle));
        }
    }
}

}  // namespace

TEST_CASE(
    "A ULog holds places, attitudes, rates and motors of the first instance of its topics, at the times of their "
    "samples") {
    const WrittenLog written(ulog_of(in_frame(small_flight(), {0, {}, 100, 1}), 10));
    const FlightLog log = written.read();
    CHECK(log.format == LogFormat::ulog);
    check_small_flight(log, 100, 1e-6);
    CHECK(log.rotor_unit == RotorUnit::share);
    REQUIRE(log.rotor_commands.width == 4);
    CHECK(log.rotor_commands.row(0)[1] == Approx(0.5));
    CHECK(log.rotor_commands.row(100)[3] == Approx(0.9));
    CHECK(log.position_m.source == "vehicle_local_position");
    CHECK(log.attitude.source == "vehicle_attitude.q");
    CHECK(log.remarks.empty());
}

TEST_CASE(
    "A DataFlash log holds the first core of the EKF, the attitude in degrees and the channels of motors in their "
    "order") {
    const WrittenLog written(dataflash_of(in_frame(small_flight(), {0, {}, 60, 1}), 10));
    const FlightLog log = written.read();
    CHECK(log.format == LogFormat::dataflash);
    check_small_flight(log, 60, 1e-4);
    CHECK(log.rotor_unit == RotorUnit::microseconds);
    REQUIRE(log.rotor_commands.width == 4);
    CHECK(log.rotor_commands.row(0)[0] == 1400);
    CHECK(log.rotor_commands.row(0)[1] == 1500);
    CHECK(log.rotor_commands.row(100)[3] == 1900);
}

TEST_CASE("Without parameters the first outputs of ArduPilot with pulses are motors, and the log says so") {
    DataFlashWriter log;
    log.format(65, 36, "XKF1", "QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD");
    log.format(67, 17, "RCOU", "QHHH", "TimeUS,C1,C2,C3");
    for (const std::uint64_t t : {1000000U, 1020000U}) {
        log.message(65, Bytes().add<std::uint64_t>(t).add<std::uint8_t>(0).add_text("", 24).text);
        log.message(
            67,
            Bytes().add<std::uint64_t>(t).add<std::uint16_t>(1100).add<std::uint16_t>(1200).add<std::uint16_t>(0).text);
    }
    const FlightLog read = WrittenLog(log.text).read();
    CHECK(read.rotor_commands.width == 2);
    REQUIRE(read.remarks.size() == 1);
    CHECK(read.remarks[0].find("the first 2") != std::string::npos);
}

TEST_CASE("The example of ULog's specification is read: a nested message, and padding that is not written") {
    // docs.px4.io: "Nested usage is allowed, i.e. a type can be used as part of another message definition."
    ULogWriter log;
    log.format("pair:float a;float b;");
    log.format("vehicle_local_position:uint64_t timestamp;pair[2] pairs;float x;float y;float z;uint8_t[4] _padding0;");
    log.subscribe(0, "vehicle_local_position");
    for (const std::uint64_t t : {2000000U, 2500000U}) {
        Bytes body;
        body.add<std::uint64_t>(t);
        for (const float number : {91.F, 92.F, 93.F, 94.F, 1.F, 2.F, -3.F}) {
            body.add<float>(number);
        }
        log.data(0, body.text);
    }
    const FlightLog read = WrittenLog(log.text).read();
    REQUIRE(read.position_m.rows() == 2);
    CHECK(read.position_m.row(1)[0] == 1);
    CHECK(read.position_m.row(1)[1] == -2);
    CHECK(read.position_m.row(1)[2] == 3);
    CHECK(read.start_s == 2);
}

TEST_CASE("Places that the autopilot does not trust are left out") {
    ULogWriter log;
    log.format("vehicle_local_position:uint64_t timestamp;float x;float y;float z;bool xy_valid;bool z_valid;");
    log.subscribe(0, "vehicle_local_position");
    for (int i = 0; i < 4; ++i) {
        Bytes body;
        body.add<std::uint64_t>(static_cast<std::uint64_t>(1000 * (i + 1))).add<float>(1).add<float>(2).add<float>(3);
        log.data(0, body.add<std::uint8_t>(i == 1 ? 0 : 1).add<std::uint8_t>(i == 2 ? 0 : 1).text);
    }
    const FlightLog read = WrittenLog(log.text).read();
    CHECK(read.position_m.rows() == 2);
    REQUIRE(read.remarks.size() == 1);
    CHECK(read.remarks[0].starts_with("2 rows of vehicle_local_position (position) are skipped"));
}

TEST_CASE("A bag holds odometry at the stamps of its headers, with velocities turned into the world, and joints") {
    LoggedFlight flight = small_flight();
    for (LoggedMoment& moment : flight) {
        moment.joints_rad = {0.1 * moment.t_s, -0.2};
    }
    const FlightLog log = WrittenLog(bag_of(in_frame(flight, {0, {}, 1.6e9, 1}))).read();
    CHECK(log.format == LogFormat::rosbag);
    CHECK(log.recorded_axes == LogAxes::up);
    CHECK(log.start_s == Approx(1.6e9));
    REQUIRE(log.position_m.rows() == 101);
    REQUIRE(log.joints_rad.rows() == 101);
    CHECK(log.position_m.source == "/odometry");
    CHECK(log.joints_rad.row(100)[0] == Approx(0.2));
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(log.position_m.row(100)[i] == Approx(flight[100].position_m[i]));
        CHECK(log.velocity_m_s.row(100)[i] == Approx(flight[100].velocity_m_s[i]).margin(1e-9));
        CHECK(log.body_rates_rad_s.row(100)[i] == Approx(flight[100].body_rates_rad_s[i]));
    }
    CHECK(log.attitude.row(100)[3] == Approx(flight[100].attitude[3]));
    CHECK(log.remarks.empty());
}

TEST_CASE("Of several topics of a kind the first is read, or those that are asked for") {
    BagWriter bag;
    bag.connect(4, "/a", "geometry_msgs/PoseStamped");
    bag.connect(5, "/b", "geometry_msgs/PoseStamped");
    for (const std::uint32_t topic : {4U, 5U}) {
        for (const double t : {10.0, 11.0}) {
            Bytes pose;
            pose.text = BagWriter::number(0) + BagWriter::stamp(t) + BagWriter::number(0);
            for (const double number : {1.0 * topic, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}) {
                pose.add<double>(number);
            }
            bag.message(topic, t, pose.text);
        }
    }
    const WrittenLog written(bag.text());
    CHECK(written.read().position_m.row(0)[0] == 4);
    CHECK(written.read().remarks.at(0).find("not /b") != std::string::npos);
    LogOptions options;
    options.topics = {"/b"};
    CHECK(written.read(options).position_m.row(0)[0] == 5);
}
