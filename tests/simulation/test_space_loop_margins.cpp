#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/space_robots.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/loop_margins.hpp"
#include "downwash/simulation/space_hover.hpp"
#include "space_twin.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// A PID on a double integrator with a hold, and a whole number of ticks of delay.
struct DoubleIntegrator {
    double kp, kd, ki, tick_s;
    int delay_ticks;

    [[nodiscard]] std::complex<double> gain(double frequency_rad_s) const {
        const std::complex<double> z = std::polar(1.0, frequency_rad_s * tick_s);
        const std::complex<double> place = tick_s * tick_s * (z + 1.0) / (2.0 * (z - 1.0) * (z - 1.0));
        const std::complex<double> speed = tick_s / (z - 1.0);
        return (kp * place + kd * speed + ki * place * tick_s / (z - 1.0)) * std::pow(z, -delay_ticks);
    }
    [[nodiscard]] double answer(double frequency_rad_s) const {
        const std::complex<double> l = gain(frequency_rad_s);
        return std::abs(l / (1.0 + l));
    }
};

/// Where a falling function passes a value.
template <class Function>
double passes(const Function& f, double value, double low, double high) {
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) > value ? low : high) = middle;
    }
    return low;
}

void check_loop(const LoopMargins& margins, const DoubleIntegrator& loop) {
    const double crossover = passes([&](double frequency) { return std::abs(loop.gain(frequency)); }, 1, 0.3, 30);
    CHECK(margins.crossover_rad_s == Approx(crossover).epsilon(1e-3));
    const double phase = std::arg(-loop.gain(crossover));
    CHECK(margins.phase_margin_rad == Approx(phase).epsilon(1e-3));
    CHECK(margins.delay_margin_s == Approx(phase / crossover).epsilon(1e-3));
    const double bandwidth =
        passes([&](double frequency) { return loop.answer(frequency); }, std::numbers::sqrt2 / 2, crossover, 60);
    CHECK(margins.bandwidth_rad_s == Approx(bandwidth).epsilon(2e-3));
}

/// A robot whose loops of height and yaw are nothing but a PID on a double integrator.
SpaceRobot plain_robot(double rate_hz, int delay_ticks) {
    SpaceRobot robot = space_robot(0);
    robot.plant.multirotor.inertia_kg_m2 = {{{0.032, 0, 0}, {0, 0.035, 0}, {0, 0, 0.055}}};
    robot.plant.time_constant_s = 0;
    robot.plant.drag = {};
    robot.controller.rate_hz = rate_hz;
    robot.controller.delay_s = delay_ticks / rate_hz;
    return robot;
}

}  // namespace

TEST_CASE("Margins of height and yaw in space are those of their transfer functions") {
    const auto [rate_hz, delay_ticks] = GENERATE(table<double, int>({{100, 0}, {100, 1}, {100, 3}, {250, 8}}));
    SpaceRobot robot = plain_robot(rate_hz, delay_ticks);
    SpaceBandwidths bandwidths;
    bandwidths.observer_gain_1_s = 0;
    bandwidths.attitude_rad_s = 6;
    SpaceInversion law = gains_for(0, bandwidths);
    law.yaw_rate_ki_1_s2 = 0;
    robot.controller.law = law;
    CAPTURE(rate_hz, delay_ticks);
    const auto margins = space_loop_margins(robot, {}).loops;
    REQUIRE(margins.size() == 6);
    // The delayed integral adds up what is seen; one more tick of a slow integral is below the tolerances here.
    check_loop(margins[space_loops::height],
               {law.height.kp_1_s2, law.height.kd_1_s, law.height.ki_1_s3, 1 / rate_hz, delay_ticks});
    check_loop(margins[space_loops::yaw],
               {law.yaw_rate_kp_1_s * law.yaw_kp_1_s, law.yaw_rate_kp_1_s, 0, 1 / rate_hz, delay_ticks});
}

TEST_CASE("The margins of the shipped planar robot in space are those of the plane") {
    Robot robot = shipped_robot_in_air();
    if (GENERATE(true, false)) {
        gains_of(robot).aids.observer.reset();
        robot.rotors.time_constant_s = 0.02;
    }
    const SpaceRobot twin = twin_of(robot);
    for (const double arm_rad : {-std::numbers::pi / 2, 0.0, 0.7, std::numbers::pi / 2}) {
        CAPTURE(arm_rad);
        const auto plane = loop_margins(robot, arm_rad);
        const auto space = space_loop_margins(twin, {arm_rad}).loops;
        REQUIRE(space.size() == 7);
        const int same[] = {space_loops::height, space_loops::pitch, space_loops::first_joint};
        for (const LoopInput input : all_loop_inputs) {
            CAPTURE(name_of(input));
            const LoopMargins& a = plane[static_cast<std::size_t>(input)];
            const LoopMargins& b = space[static_cast<std::size_t>(same[static_cast<std::size_t>(input)])];
            CHECK(b.gain_margin_db == Approx(a.gain_margin_db).epsilon(1e-5));
            CHECK(b.phase_margin_rad == Approx(a.phase_margin_rad).epsilon(1e-5));
            CHECK(b.crossover_rad_s == Approx(a.crossover_rad_s).epsilon(1e-5));
            CHECK(b.delay_margin_s == Approx(a.delay_margin_s).epsilon(1e-5));
        }
    }
}

TEST_CASE("Where a longer delay makes a hover in space unstable, a loop has no phase margin left") {
    const bool has_cascade = GENERATE(false, true);
    SpaceRobot robot = space_robot(has_cascade ? 0 : 2);
    if (has_cascade) {
        robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
    }
    const std::vector<double> joints_rad(robot.links.size(), 0.3);
    const auto is_stable = [&](double delay_s) {
        robot.controller.delay_s = delay_s;
        return error_of([&] { static_cast<void>(space_loop_margins(robot, joints_rad)); }) == "none";
    };
    double stable_s = 0, unstable_s = 0.3;
    REQUIRE(is_stable(stable_s));
    REQUIRE_FALSE(is_stable(unstable_s));
    while (unstable_s - stable_s > 1e-4) {
        const double middle_s = 0.5 * (stable_s + unstable_s);
        (is_stable(middle_s) ? stable_s : unstable_s) = middle_s;
    }
    robot.controller.delay_s = stable_s;
    double least_rad = 1;
    for (const LoopMargins& margins : space_loop_margins(robot, joints_rad).loops) {
        least_rad = std::min(least_rad, margins.phase_margin_rad);
    }
    CHECK(least_rad < 0.02);
}

TEST_CASE("With gains from bandwidths the multirotor's loops keep 6 dB in every pose, with any number of joints") {
    const int joints = GENERATE(0, 1, 2, 3);
    SpaceRobot robot = space_robot(joints);
    CAPTURE(joints);
    for (const ExaminedPose& pose : examined_poses(robot)) {
        const SpaceLoopMargins margins = space_loop_margins(robot, pose.joints_rad);
        REQUIRE(margins.loops.size() == static_cast<std::size_t>(6 + joints));
        CHECK(margins.stability.growth_rate_1_s < 0);
        for (int loop = 0; loop < 6 + joints; ++loop) {
            CAPTURE(pose.name, space_loop_name(loop));
            // Joints of a light arm below a light vehicle have less, which the command says.
            CHECK(margins.loops[static_cast<std::size_t>(loop)].gain_margin_db >
                  (loop < space_loops::first_joint ? 6 : 1));
            CHECK(margins.loops[static_cast<std::size_t>(loop)].phase_margin_rad > 0.2);
        }
    }
    robot.controller.delay_s = 0.25;
    CHECK_THAT(error_of([&] { static_cast<void>(space_loop_margins(robot, std::vector<double>(robot.links.size()))); }),
               Catch::Contains("the loop is unstable, most of all in "));
}
