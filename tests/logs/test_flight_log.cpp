#include <catch2/catch.hpp>
#include <limits>

#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/rotation.hpp"

// Series of numbers over time, and the axes of a log.

using namespace downwash;

TEST_CASE("A series takes rows of finite numbers at rising times alone") {
    LogSeries series;
    series.width = 2;
    const double good[] = {1, 2}, bad[] = {1, std::numeric_limits<double>::quiet_NaN()};
    CHECK(series.add(1, good));
    CHECK_FALSE(series.add(1, good));
    CHECK_FALSE(series.add(0.5, good));
    CHECK_FALSE(series.add(2, bad));
    CHECK_FALSE(series.add(std::numeric_limits<double>::infinity(), good));
    CHECK(series.rows() == 1);
}

TEST_CASE("Between rows a series is linear, and there is nothing before it, behind it and within a gap") {
    LogSeries series;
    series.width = 1;
    for (const double t : {0.0, 1.0, 2.0, 10.0, 11.0}) {
        const double row[] = {10 * t};
        series.add(t, row);
    }
    LogCursor cursor(series, 2);
    const auto value = [&cursor](double t) {
        const auto at = cursor.place(t);
        return at ? std::optional(cursor.number(*at, 0)) : std::nullopt;
    };
    CHECK(value(0) == 0.0);
    CHECK(value(0.25) == 2.5);
    CHECK(value(10.5) == 105.0);
    CHECK(value(1.5) == 15.0);  // back
    CHECK(value(11) == 110.0);
    CHECK_FALSE(value(5));
    CHECK_FALSE(value(-0.1));
    CHECK_FALSE(value(11.1));
    CHECK(value(2) == 20.0);
}

TEST_CASE("A log with z down is turned over: a nose that is up stays up") {
    FlightLog log;
    log.recorded_axes = LogAxes::down;
    log.attitude.width = 4;
    log.attitude.add(
        100, quaternion_of_angles(0, 0.3, 0.2));  // north, east, down: positive pitch is nose up, yaw to the east
    log.position_m.width = 3;
    const double place[] = {1, 2, -3};
    log.position_m.add(101, place);
    finish(log);
    CHECK(log.start_s == 100);
    CHECK(log.duration_s == 1);
    CHECK(log.position_m.t_s[0] == 1);
    CHECK(log.position_m.row(0)[1] == -2);
    CHECK(log.position_m.row(0)[2] == 3);
    // With z up, yaw to the west is positive, and so is a pitch nose down.
    const auto wanted = quaternion_of_angles(0, -0.3, -0.2);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(log.attitude.row(0)[i] == Approx(wanted[i]).margin(1e-12));
    }
    turn_over(log);
    CHECK(log.position_m.row(0)[2] == -3);
}

TEST_CASE("Quaternions of a log have length 1 and do not jump to the other sign") {
    FlightLog log;
    log.attitude.width = 4;
    for (const double sign : {1.0, -1.02, 0.01, 1.0}) {
        const double q[] = {0.6 * sign, 0.8 * sign, 0, 0};
        log.attitude.add(static_cast<double>(log.attitude.rows()) + (sign == 0.01 ? 0.5 : 0), q);
    }
    finish(log);
    REQUIRE(log.attitude.rows() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(log.attitude.row(i)[0] == Approx(0.6));
    }
}
