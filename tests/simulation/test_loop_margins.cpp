#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "../support/error_of.hpp"
#include "../support/test_robot.hpp"
#include "downwash/simulation/loop_margins.hpp"
#include "hover_scenes.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

LoopMargins of(const std::array<LoopMargins, 3>& all, LoopInput input) {
    return all[static_cast<std::size_t>(input)];
}

/// The height loop of a hanging arm: a PID on a double integrator with a hold, and a whole number of ticks of delay.
std::complex<double> height_loop(const ModelInversion& gains, double tick_s, int delay_ticks, double frequency_rad_s) {
    const std::complex<double> z = std::polar(1.0, frequency_rad_s * tick_s);
    const std::complex<double> height = tick_s * tick_s * (z + 1.0) / (2.0 * (z - 1.0) * (z - 1.0));
    const std::complex<double> speed = tick_s / (z - 1.0);
    return (gains.position_kp * height + gains.position_kd * speed + gains.position_ki * height * tick_s / (z - 1.0)) *
           std::pow(z, -delay_ticks);
}

}  // namespace

TEST_CASE("The margins of the height loop are those of its transfer function") {
    Robot robot = test_robot();
    const auto [rate_hz, delay_ticks] =
        GENERATE(table<double, int>({{100, 0}, {100, 1}, {100, 3}, {250, 8}, {1000, 32}}));
    const double tick_s = 1 / rate_hz;
    robot.controller.rate_hz = rate_hz;
    robot.controller.delay_s = tick_s * delay_ticks;
    const ModelInversion& gains = gains_of(robot);
    // The delayed integral adds up what is seen; one more tick of a slow integral is below the tolerances here.
    const LoopMargins margins = of(loop_margins(robot, quarter_turn), LoopInput::thrust);
    double low = 0.5, high = 20;  // the only crossing of 1
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::abs(height_loop(gains, tick_s, delay_ticks, middle)) > 1 ? low : high) = middle;
    }
    CHECK(margins.crossover_rad_s == Approx(low).epsilon(1e-3));
    const double phase = std::arg(-height_loop(gains, tick_s, delay_ticks, low));
    CHECK(margins.phase_margin_rad == Approx(phase).epsilon(1e-3));
    CHECK(margins.delay_margin_s == Approx(phase / low).epsilon(1e-3));
}

TEST_CASE("Where a longer delay makes a hover unstable, a loop has no phase margin left") {
    Robot robot = test_robot();
    const auto is_stable = [&](double delay_s) {
        robot.controller.delay_s = delay_s;
        return analyse_hover(in_free_air(robot), 0, 0, quarter_turn).verdict == HoldVerdict::stable;
    };
    double stable_s = 0.02, unstable_s = 0.25;
    REQUIRE(is_stable(stable_s));
    REQUIRE_FALSE(is_stable(unstable_s));
    while (unstable_s - stable_s > 1e-5) {
        const double middle_s = 0.5 * (stable_s + unstable_s);
        (is_stable(middle_s) ? stable_s : unstable_s) = middle_s;
    }
    REQUIRE(stable_s * robot.controller.rate_hz > simulation::recent_ticks);
    const auto least_rad = [&](double delay_s) {
        robot.controller.delay_s = delay_s;
        double least = quarter_turn;
        for (const LoopMargins& margins : loop_margins(robot, quarter_turn)) {
            least = std::min(least, margins.phase_margin_rad);
        }
        return least;
    };
    const double at_limit_rad = least_rad(stable_s);
    CHECK(at_limit_rad < 0.005);
    CHECK(least_rad(0.8 * stable_s) > 5 * at_limit_rad);
}

TEST_CASE("A loop's gain margin counts where its curve ends, at half the sampling frequency") {
    Robot robot = test_robot();
    robot.controller.delay_s = 0;
    gains_of(robot).position_kd = 20;  // 1/s; the other crossings are farther from -1
    const LoopMargins margins = of(loop_margins(robot, quarter_turn), LoopInput::thrust);
    const std::complex<double> end = height_loop(gains_of(robot), 0.01, 0, std::numbers::pi / 0.01);
    REQUIRE(end.real() < 0);
    CHECK(margins.gain_margin_db == Approx(-20 * std::log10(-end.real())).epsilon(1e-6));
}

TEST_CASE("A loop loses its margin with rotor lag and delay, and has none where it is unstable") {
    Robot robot = test_robot();
    const double at_once = of(loop_margins(robot, 0.0), LoopInput::pitch_torque).phase_margin_rad;
    robot.rotors.time_constant_s = 0.02;
    const double lagging = of(loop_margins(robot, 0.0), LoopInput::pitch_torque).phase_margin_rad;
    robot.controller.delay_s = 0.01;
    const double late = of(loop_margins(robot, 0.0), LoopInput::pitch_torque).phase_margin_rad;
    CHECK(lagging < at_once);
    CHECK(late < lagging);
    robot.rotors.time_constant_s = 0.2;
    CHECK_THAT(error_of([&] { static_cast<void>(loop_margins(robot, 0.0)); }), Catch::Contains("unstable"));
}

TEST_CASE(
    "the cascaded PID keeps 6 dB and 45 degrees with its default gains, with lag and delay and the arm anywhere") {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.05;
    robot.controller.delay_s = 0.01;
    CascadedPid law;
    law.rotor_lead = 1;
    robot.controller.law = law;
    for (const double arm_rad : {-quarter_turn, 0.0, quarter_turn}) {
        for (const LoopMargins& margins : loop_margins(robot, arm_rad)) {
            CHECK(margins.gain_margin_db > 6);
            CHECK(margins.phase_margin_rad > quarter_turn / 2);
        }
    }
}
