#include <catch2/catch.hpp>

#include "../support/error_of.hpp"
#include "downwash/identification/recorded_flight.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

SpaceRobot hexarotor() {
    return read_space_robot(DOWNWASH_ROBOTS "/hexa370_arm3.yaml");
}

void fill(LogSeries& series, std::vector<double> row, double from_s, double to_s, double step_s) {
    series.width = row.size();
    for (int i = 0; from_s + i * step_s <= to_s + 1e-9; ++i) {
        row.front() = from_s + i * step_s;  // what the first number is can be told from the time
        series.add(from_s + i * step_s, row);
    }
}

/// Five seconds of a log of the hexarotor, whose series have rates of their own.
FlightLog whole_log() {
    FlightLog log;
    log.files = {"flight.ulg"};
    fill(log.position_m, {0, 0, 2}, 0, 5, 0.02);
    fill(log.velocity_m_s, {0, 0, 0}, 0, 5, 0.02);
    fill(log.body_rates_rad_s, {0, 0, 0}, 0, 5, 0.005);
    fill(log.joints_rad, {0, 0, 0}, 0, 5, 0.02);
    fill(log.joint_rates_rad_s, {0, 0, 0}, 0, 5, 0.02);
    fill(log.joint_torques_nm, {0, 0, 0}, 0, 5, 0.02);
    fill(log.rotor_commands, {0, 4, 4, 4, 4, 4}, 0, 5, 0.01);
    log.attitude.width = 4;
    for (int i = 0; i <= 250; ++i) {
        log.attitude.add(0.02 * i, std::vector<double>{1, 0, 0, 0});
    }
    return log;
}

}  // namespace

TEST_CASE("a log is read at the times of its rotor commands, with everything else between its own rows") {
    const LoggedFlight flight = recorded_flight(whole_log(), hexarotor());
    REQUIRE(flight.ticks.size() == 501);
    CHECK(flight.ticks[101].t_s == Approx(1.01));
    CHECK(flight.ticks[101].seen.position_m[0] == Approx(1.01));
    CHECK(flight.ticks[101].rotor_command_n[0] == Approx(1.01));
    CHECK(flight.ticks[101].rotor_command_n[5] == 4);
    CHECK_FALSE(flight.has_reference);
}

TEST_CASE("what a log lacks is named") {
    FlightLog log = whole_log();
    log.joint_torques_nm = {};
    log.rotor_commands.width = 3;
    const std::string error = test::error_of([&] { return recorded_flight(log, hexarotor()); });
    CHECK_THAT(error, Contains("flight.ulg: has no joint torques") && Contains("has 3 rotor commands: expected 6"));
}

TEST_CASE("a log with gaps gives its longest stretch without one") {
    FlightLog log = whole_log();
    LogSeries cut;
    cut.width = 3;
    for (std::size_t i = 0; i < log.position_m.rows(); ++i) {
        if (const double t = log.position_m.t_s[i]; t < 1 || (t > 1.5 && t < 4) || t > 4.5) {
            cut.add(t, log.position_m.row(i));
        }
    }
    log.position_m = cut;
    const LoggedFlight flight = recorded_flight(log, hexarotor());
    CHECK(flight.ticks.front().t_s == Approx(1.52));
    CHECK(flight.ticks.back().t_s == Approx(3.98));
}

TEST_CASE("commands that are shares become thrusts by the power that is given, and are refused without it") {
    FlightLog log = whole_log();
    log.rotor_unit = RotorUnit::share;
    CHECK_THAT(test::error_of([&] { return recorded_flight(log, hexarotor()); }), Contains("--thrust-exponent"));
    RecordedFlightOptions options;
    options.thrust_exponent = 2;
    const LoggedFlight flight = recorded_flight(log, hexarotor(), options);
    CHECK(flight.ticks[50].rotor_command_n[0] == Approx(20.7 * 0.25));  // the share is the time, 0.5
    CHECK(flight.ticks[50].rotor_command_n[1] == Approx(20.7));         // full command
}
