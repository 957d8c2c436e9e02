#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>

#include "../support/error_of.hpp"
#include "written.hpp"

// Tables of flights: of ours, of ulog2csv and pandas, and with columns that a user declares.

using namespace downwash;
using namespace downwash::test;

namespace {

std::string table_error(const std::string& text, const LogOptions& options = {}) {
    const WrittenLog log(text, "flight.csv");
    const std::string error = error_of([&] { return log.read(options); });
    const std::size_t place = error.find("flight.csv:");
    return place == std::string::npos ? error : error.substr(place + 11);
}

}  // namespace

TEST_CASE("A table of pandas with an index without a name is read, and what is guessed is said") {
    const FlightLog log = WrittenLog(pandas_csv_of(small_flight()), "flight.csv").read();
    CHECK(log.format == LogFormat::csv);
    REQUIRE(log.position_m.rows() == 101);
    CHECK(log.position_m.row(100)[2] == Approx(1.6));
    CHECK(log.attitude.row(100)[3] == Approx(small_flight()[100].attitude[3]).margin(1e-6));
    CHECK(log.axes_source == AxesSource::guessed);
    CHECK(log.recorded_axes == LogAxes::up);
    REQUIRE(log.remarks.size() == 1);
    CHECK(log.remarks[0].find("the times in time are taken for seconds") != std::string::npos);
}

TEST_CASE("Files of ulog2csv are tables of one flight: times in microseconds, north, east, down") {
    ScratchFolder folder;
    const auto places = folder / "log_vehicle_local_position_0.csv", attitude = folder / "log_vehicle_attitude_0.csv";
    std::ofstream(places) << ulog2csv_of(small_flight());
    std::ofstream(attitude) << "timestamp,q[0],q[1],q[2],q[3]\n1000900,1,0,0,0\n1500900,0,1,0,0\n";
    const FlightLog log = read_flight_log({places, attitude});
    CHECK(log.recorded_axes == LogAxes::down);
    CHECK(log.axes_source == AxesSource::format);
    REQUIRE(log.position_m.rows() == 101);
    CHECK(log.position_m.row(50)[1] == Approx(0.1));
    CHECK(log.position_m.row(50)[2] == Approx(1.3));
    CHECK(log.position_m.t_s[50] == Approx(1));
    REQUIRE(log.attitude.rows() == 2);
    CHECK(log.attitude.t_s[0] == Approx(1));
    CHECK(log.files.size() == 2);
    CHECK(log.remarks.empty());
}

TEST_CASE("A set-point of ulog2csv is not taken for the place of the vehicle") {
    ScratchFolder folder;
    const auto wanted = folder / "log_vehicle_local_position_setpoint_0.csv";
    std::ofstream(wanted) << "timestamp,x,y,z\n1000,1,2,-3\n3000,1,2,-4\n";
    CHECK(error_of([&] { return read_flight_log({wanted}); }).find("there is no position in this log") !=
          std::string::npos);
    const auto places = folder / "log_vehicle_local_position_0.csv";
    std::ofstream(places) << "timestamp,x,y,z\n1000,7,2,-3\n3000,7,2,-4\n";
    const FlightLog log = read_flight_log({wanted, places});
    CHECK(log.position_m.row(0)[0] == 7);
    CHECK(log.setpoint_m.row(1)[2] == 4);
}

TEST_CASE("Columns are declared by name, with units and axes") {
    LogOptions options;
    options.columns = {{"t", "when"},   {"x", "north"}, {"y", "east"}, {"z", "down"},
                       {"yaw", "head"}, {"roll", "a"},  {"pitch", "b"}};
    options.time_unit_s = 1e-3;
    options.axes = LogAxes::down;
    options.angles_in_degrees = true;
    const FlightLog log =
        WrittenLog("when;north;east;down;a;b;head\n10;1,5;2,5;-3,5;0;0;90\n30;1,5;2,5;-3,5;0;0;90\n", "flight.csv")
            .read(options);
    CHECK(log.position_m.t_s[1] == Approx(0.02));
    CHECK(log.position_m.row(0)[0] == 1.5);
    CHECK(log.position_m.row(0)[1] == -2.5);
    CHECK(log.position_m.row(0)[2] == 3.5);
    CHECK(log.attitude.row(0)[3] == Approx(-std::sqrt(0.5)));
    CHECK(log.axes_source == AxesSource::declared);
    CHECK(log.remarks.empty());
}

TEST_CASE("A trajectory.csv of a plane is a log with a pitch and one joint") {
    const FlightLog log =
        WrittenLog(
            "t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,pitch_rate_rad_s,"
            "arm_rate_rad_s,clearance_m,rotor_1_cmd_n,rotor_1_aero_factor,rotor_2_cmd_n\n"
            "0,1,2,0.5,1.1,2.2,0.1,0.6,0,0.3,0.2,0.7,,5,1,6\n0.01,1,2,0.5,1.1,2.2,0.1,0.6,0,0.3,0.2,0.7,,5,1,6\n",
            "trajectory.csv")
            .read();
    REQUIRE(log.position_m.rows() == 2);
    CHECK(log.position_m.row(0)[0] == 1.1);
    CHECK(log.position_m.row(0)[1] == 0);
    CHECK(log.position_m.row(0)[2] == 2.2);
    CHECK(log.attitude.row(0)[2] == Approx(std::sin(0.05)));
    CHECK(log.body_rates_rad_s.row(0)[1] == 0.2);
    CHECK(log.joints_rad.row(0)[0] == 0.6);
    CHECK(log.joint_rates_rad_s.row(0)[0] == 0.7);
    CHECK(log.setpoint_m.row(0)[0] == 1);
    REQUIRE(log.rotor_commands.width == 2);
    CHECK(log.rotor_commands.row(0)[1] == 6);
    CHECK(log.rotor_unit == RotorUnit::newton);
    CHECK(log.axes_source == AxesSource::format);
    CHECK(log.remarks.empty());
}

TEST_CASE("Rows without a number leave out their series, and rows that go back in time are counted") {
    const FlightLog log =
        WrittenLog(
            "t_s,x,y,z,yaw,roll,pitch\n0,1,2,3,0,0,0\n1,1,2,nan,0,0,0\n2,,2,3,0,0,0\n1.5,1,2,3,0,0,0\n3,1,2,3,0,0,0\n",
            "flight.csv")
            .read();
    CHECK(log.position_m.rows() == 3);
    CHECK(log.attitude.rows() == 4);
    CHECK(log.remarks.back().find("1 rows are skipped") != std::string::npos);
}

TEST_CASE("A table that is no log is an error with line and column") {
    CHECK(table_error("a,b\n1,2\n").starts_with("1: has no column of times"));
    CHECK(table_error("t,b\n1,2\n").starts_with("1: has nothing of a flight"));
    CHECK(table_error("t_s,x,y,z\n1,2,3,4\n2,2,oops,4\n").starts_with("3:5: y is 'oops'"));
    CHECK(table_error("t_s,x,y,z\n1,2,3\n").starts_with("2: "));
    LogOptions options;
    options.columns = {{"x", "east"}};
    CHECK(table_error("t_s,x,y,z\n1,2,3,4\n", options).find("there is no column east to be x") != std::string::npos);
    options.columns = {{"yaw", "heading"}};
    CHECK(table_error("t_s,x,y,z\n1,2,3,4\n", options)
              .starts_with(" there is no column 'heading', which is said to be yaw"));
    options.columns = {{"north", "x"}};
    CHECK(table_error("t_s,x,y,z\n1,2,3,4\n", options).find("there is no such signal") != std::string::npos);
    CHECK(table_error("").find("holds no table") != std::string::npos);
}

TEST_CASE("The unit of times follows from the step between rows") {
    for (const auto& [step, unit, name] :
         {std::tuple{0.004, 1.0, "seconds"}, std::tuple{4.0, 1e-3, "milliseconds"},
          std::tuple{4000.0, 1e-6, "microseconds"}, std::tuple{4e6, 1e-9, "nanoseconds"}}) {
        std::string text = "timestamp,x,y,z\n";
        for (int i = 0; i < 5; ++i) {
            text += std::to_string(step * i) + ",1,2,3\n";
        }
        const FlightLog log = WrittenLog(text, "flight.csv").read();
        CHECK(log.duration_s == Approx(4 * step * unit));
        CHECK(log.remarks[0].find(name) != std::string::npos);
    }
}

TEST_CASE("The columns of a table decide whether PX4 wrote it, not the name of its file") {
    const FlightLog own = WrittenLog("t,x,y,z\n0,1,2,3\n0.1,1,2,3\n", "vehicle_track.csv").read();
    CHECK(own.recorded_axes == LogAxes::up);
    CHECK(own.axes_source == AxesSource::guessed);
    CHECK(own.duration_s == Approx(0.1));
    const FlightLog px4 =
        WrittenLog("timestamp,x,y,z,xy_valid,z_valid\n0,1,2,-3,1,1\n100000,1,2,-3,1,1\n", "mine.csv").read();
    CHECK(px4.recorded_axes == LogAxes::down);
    CHECK(px4.axes_source == AxesSource::format);
    CHECK(px4.duration_s == Approx(0.1));
    CHECK(px4.remarks.empty());
    const FlightLog named =
        WrittenLog("timestamp,x,y,z\n0,1,2,-3\n100000,1,2,-3\n", "a_vehicle_local_position_0.csv").read();
    CHECK(named.recorded_axes == LogAxes::down);
    REQUIRE(named.remarks.size() == 1);
    CHECK(named.remarks[0].find("--axes says otherwise") != std::string::npos);
    const FlightLog odometry =
        WrittenLog("timestamp,position[0],position[1],position[2],q[0],q[1],q[2],q[3]\n0,1,2,-3,1,0,0,0\n", "o.csv")
            .read();
    CHECK(odometry.position_m.row(0)[2] == 3);
    CHECK(odometry.setpoint_m.empty());
}

TEST_CASE("Units and directions in the names of columns count") {
    const FlightLog log = WrittenLog(
                              "Time (ms);Pos X [mm];Pos Y [mm];Pos Z [mm];Roll (deg);Pitch (deg);Yaw (deg);wx (deg/s);"
                              "wy (deg/s);wz (deg/s);joint1 (deg)\n"
                              "0;1500,5;2000;3000;0;0;1;180;0;0;90\n20;1500,5;2000;3000;0;0;1;180;0;0;90\n",
                              "flight.csv")
                              .read();
    CHECK(log.duration_s == Approx(0.02));
    CHECK(log.position_m.row(0)[0] == Approx(1.5005));
    CHECK(log.attitude.row(0)[3] == Approx(std::sin(0.5 / 57.29577951308232)));
    CHECK(log.body_rates_rad_s.row(0)[0] == Approx(3.141592653589793));
    CHECK(log.joints_rad.row(0)[0] == Approx(1.5707963267948966));
    CHECK(log.remarks.empty());
    const FlightLog north = WrittenLog("TimeUS,PN,PE,PD\n0,1,2,-3\n100000,1,2,-3\n", "xkf1.csv").read();
    CHECK(north.axes_source == AxesSource::format);
    CHECK(north.position_m.row(0)[1] == -2);
    CHECK(north.position_m.row(0)[2] == 3);
    const FlightLog east = WrittenLog("t_s,north_m,east_m,up_m\n0,1,2,3\n1,1,2,3\n", "track.csv").read();
    CHECK(east.position_m.row(0)[0] == 2);
    CHECK(east.position_m.row(0)[2] == 3);
    CHECK(east.axes_source == AxesSource::format);
}

TEST_CASE("The twist of an odometry is in the frame of the body") {
    const std::string begin =
        "%time,field.pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z,"
        "field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,"
        "field.pose.pose.orientation.w,field.twist.twist.linear.x,field.twist.twist.linear.y,"
        "field.twist.twist.linear.z\n";
    const double half = std::sqrt(0.5);  // yaw of 90 degrees: forward is y
    const std::string turned = ",0,0,1,0,0," + std::to_string(half) + "," + std::to_string(half) + ",2,0,0.5\n";
    const FlightLog log = WrittenLog(begin + "1000000000" + turned + "1010000000" + turned, "odometry.csv").read();
    REQUIRE(log.velocity_m_s.rows() == 2);
    CHECK(log.velocity_m_s.row(0)[0] == Approx(0).margin(1e-5));
    CHECK(log.velocity_m_s.row(0)[1] == Approx(2).epsilon(1e-5));
    CHECK(log.velocity_m_s.row(0)[2] == Approx(0.5));
    CHECK(std::ranges::any_of(
        log.remarks, [](const auto& remark) { return remark.find("frame of the body") != std::string::npos; }));

    const FlightLog lacking = WrittenLog(
                                  "time,x,y,z,twist.twist.linear.x,twist.twist.linear.y,twist.twist.linear.z\n0,0,0,1,"
                                  "2,0,0\n0.01,0,0,1,2,0,0\n",
                                  "odometry.csv")
                                  .read();
    CHECK(lacking.velocity_m_s.empty());
}
