#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "../support/error_of.hpp"
#include "../support/log_writers.hpp"
#include "downwash/comparison/alignment.hpp"

// A plan is found in a log, in time and space.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Half a minute along a curve that never repeats itself.
PlannedFlight curve() {
    PlannedFlight planned;
    planned.tick_s = 0.01;
    for (int i = 0; i <= 3000; ++i) {
        const double t = 0.01 * i;
        PlannedRow row;
        row.t_s = t;
        row.position_m = {2 * std::sin(0.3 * t) + 0.5 * std::sin(1.1 * t), 1.5 * std::cos(0.23 * t),
                          2 + 0.6 * std::sin(0.41 * t + 1)};
        planned.rows.push_back(row);
    }
    return planned;
}

FlightLog log_of(const PlannedFlight& planned, const LogFrame& frame, double noise_m = 0, double before_s = 0) {
    LoggedFlight flight;
    for (double t = -before_s; t < planned.rows.back().t_s + before_s; t += 0.013) {
        const double at = std::clamp(t, 0.0, planned.rows.back().t_s);
        LoggedMoment moment;
        moment.t_s = t;
        moment.position_m = planned.rows[static_cast<std::size_t>(at / planned.tick_s)].position_m;
        flight.push_back(moment);
    }
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1);
    FlightLog log;
    log.position_m.width = 3;
    for (const LoggedMoment& moment : in_frame(std::move(flight), frame)) {
        const double row[] = {moment.position_m[0] + noise_m * noise(random),
                              moment.position_m[1] + noise_m * noise(random),
                              moment.position_m[2] + noise_m * noise(random)};
        log.position_m.add(moment.t_s, row);
    }
    return log;
}

}  // namespace

TEST_CASE("A square that was turned by 30 degrees and moved is brought back by the fit of a yaw") {
    const std::vector<Vector3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
    std::vector<Vector3> moved;
    const double c = std::cos(0.5235987755982988), s = 0.5;
    for (const Vector3& p : square) {
        moved.push_back({c * p[0] - s * p[1] + 3, s * p[0] + c * p[1] - 2, p[2] + 5});
    }
    const YawFit fit = fit_yaw(square, moved);
    CHECK(fit.yaw_rad == Approx(0.5235987755982988));
    CHECK(fit.shift_m[0] == Approx(3));
    CHECK(fit.shift_m[1] == Approx(-2));
    CHECK(fit.shift_m[2] == Approx(5));
    CHECK(fit.residual_m == Approx(0).margin(1e-12));
    CHECK(fit.spread_m == Approx(std::sqrt(0.5)));
    // One corner lifted by 4 mm: a quarter of it goes into the shift, and of squares 3/4 of 16 remain over 4 points.
    moved[0][2] += 0.004;
    CHECK(fit_yaw(square, moved).residual_m == Approx(0.004 * std::sqrt(3) / 4));
}

TEST_CASE("Offset, yaw and shift of a log are found, with noise and with a rest before and behind") {
    const PlannedFlight planned = curve();
    const LogFrame frame{2.1, {4, -3, 0.7}, 81.37, 1};
    const LogAlignment found = align(log_of(planned, frame, 0.02, 20), planned);
    CHECK(found.offset_s == Approx(81.37).margin(0.02));
    CHECK(found.rate == 1);
    CHECK(found.yaw_rad == Approx(2.1).margin(0.005));
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(found.shift_m[i] == Approx(frame.shift_m[i]).margin(0.01));
    }
    // Noise of three axes; between two samples its square is (1 - s)^2 + s^2 of that, on average two thirds.
    CHECK(found.residual_m == Approx(0.02 * std::sqrt(3 * 2.0 / 3)).epsilon(0.05));
    CHECK(found.covered == 1);
    CHECK(found.correlation > 0.5);
}

TEST_CASE("A clock that runs half a percent fast is found, and one that does not is left alone") {
    const PlannedFlight planned = curve();
    const LogAlignment found = align(log_of(planned, {0.4, {1, 2, 3}, 12, 1.005}), planned);
    CHECK(found.is_rate_fitted);
    CHECK(found.rate == Approx(1.005).margin(2e-4));
    CHECK(found.offset_s == Approx(12).margin(0.02));
    CHECK_FALSE(align(log_of(planned, {0.4, {1, 2, 3}, 12, 1}, 0.01), planned).is_rate_fitted);
}

TEST_CASE("A log that ends before the plan covers the part that it has") {
    const PlannedFlight planned = curve();
    FlightLog log = log_of(planned, {0.3, {0, 0, 0}, 5, 1});
    while (log.position_m.t_s.back() > 5 + 18) {
        log.position_m.t_s.pop_back();
        log.position_m.numbers.resize(log.position_m.numbers.size() - 3);
    }
    const LogAlignment found = align(log, planned);
    CHECK(found.offset_s == Approx(5).margin(0.05));
    CHECK(found.covered == Approx(0.6).margin(0.01));
}

TEST_CASE("Guessed axes that are wrong are turned over, and the alignment says so") {
    const PlannedFlight planned = curve();
    FlightLog log = log_of(planned, {0.3, {0, 0, 0}, 5, 1});
    turn_over(log);
    log.axes_source = AxesSource::guessed;
    const LogAlignment found = align(log, planned);
    CHECK(found.is_turned_over);
    CHECK(found.residual_m < 0.05);
    REQUIRE_FALSE(found.remarks.empty());
    CHECK(found.remarks.back().find("down fits the plan") != std::string::npos);
    log.axes_source = AxesSource::declared;
    CHECK_FALSE(align(log, planned).is_turned_over);
}

TEST_CASE("A plan that only rises tells no yaw, which then comes from the attitude") {
    PlannedFlight planned = curve();
    for (PlannedRow& row : planned.rows) {
        row.position_m[0] = row.position_m[1] = 0;
        row.reference_yaw_rad = 0.25;
    }
    FlightLog log = log_of(planned, {-0.8, {1, 1, 1}, 3, 1});
    const LogAlignment without = align(log, planned);
    CHECK(without.yaw_rad == 0);
    REQUIRE(without.remarks.size() == 1);
    log.attitude.width = 4;
    const double yaw = 0.25 + 0.8;  // of the body in the log's frame
    const double q[] = {std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)};
    for (double t = 3; t < 30; t += 0.5) {
        log.attitude.add(t, q);
    }
    CHECK(align(log, planned).yaw_rad == Approx(-0.8));
}

TEST_CASE("Places of the problem's world and a given time are taken as they are") {
    const PlannedFlight planned = curve();
    AlignmentOptions options;
    options.offset_s = 7.5;
    options.is_in_world = true;
    const LogAlignment found = align(log_of(planned, {0, {0, 0, 0}, 7.5, 1}), planned, options);
    CHECK(found.offset_s == 7.5);
    CHECK(found.yaw_rad == 0);
    CHECK(found.shift_m == Vector3{});
    CHECK(found.residual_m < 0.02);
    CHECK_FALSE(found.is_time_fitted);
}

TEST_CASE("The log of another flight is compared with a warning") {
    PlannedFlight other = curve();
    for (PlannedRow& row : other.rows) {
        row.position_m = {0.01 * row.t_s * row.t_s, 0, 1 + (row.t_s > 20 ? 0.3 * (row.t_s - 20) : 0)};
    }
    FlightLog log = log_of(curve(), {0, {0, 0, 0}, 5, 1});
    for (double& number : log.position_m.numbers) {
        number *= 8;
    }
    const LogAlignment found = align(log, other);
    CHECK(found.correlation < 0.5);
    REQUIRE_FALSE(found.remarks.empty());
    CHECK(found.remarks.back().find("is it the log of this flight?") != std::string::npos);
}

TEST_CASE("A plan that does not move, or that the log hardly covers, is an error with a remedy") {
    PlannedFlight still = curve();
    for (PlannedRow& row : still.rows) {
        row.position_m = {1, 1, 1};
    }
    const FlightLog log = log_of(curve(), {0, {0, 0, 0}, 5, 1});
    CHECK(error_of([&] { return align(log, still); }).find("--time-offset") != std::string::npos);
    AlignmentOptions late;
    late.offset_s = 33;
    CHECK(error_of([&] { return align(log, curve(), late); }).find("of the plan: expected 20 % or more") !=
          std::string::npos);
}
