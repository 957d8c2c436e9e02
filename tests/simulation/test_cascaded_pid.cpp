#include <catch2/catch.hpp>
#include <cmath>

#include "../support/single_tick.hpp"
#include "hover_scenes.hpp"

// The cascaded PID in closed loop.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double gravity = 9.80665;
constexpr double tick_s = 0.01;
constexpr double mass_kg = 4.95;

Robot robot_with(const CascadedPid& law) {
    Robot robot = test_robot();
    robot.controller.law = law;
    return robot;
}

FlightState flown(const FlightModel& model, FlightState state, const ReferencePoint& reference, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        controllers::Actuation<double> given{};
        state = single_tick(model.tick(), state, reference, given);
    }
    return state;
}

}  // namespace

TEST_CASE("a cascaded PID starts as a hover in free air, whatever its arm weighs") {
    const FlightModel model = in_free_air(robot_with({}));
    for (const double arm : {-2.0, 0.0, 0.7, quarter_turn}) {
        const FlightState end = flown(model, model.state_at({1, 2, 0, arm}), at_rest({1, 2, arm}), 300);
        CHECK(end.plant.q[0] == Approx(1).margin(1e-9));
        CHECK(end.plant.q[1] == Approx(2).margin(1e-9));
        CHECK(end.plant.q[2] == Approx(0).margin(1e-9));
        CHECK(end.plant.q[3] == Approx(arm).margin(1e-9));
    }
}

TEST_CASE("with a hanging arm the height follows the cascade written by hand, tick by tick") {
    CascadedPid law;
    law.vertical_velocity_kd = 0.1;
    const FlightModel model = in_free_air(robot_with(law));
    FlightState state = model.state_at({0, 2, 0, quarter_turn});
    ReferencePoint reference = at_rest({0, 2.3, quarter_turn});
    reference.velocity[1] = 0.1;
    reference.acceleration[1] = -0.2;
    double z_m = 2;
    double speed_m_s = 0;
    double previous_m_s = 0;
    double integral_m = 0;
    for (int i = 0; i < 500; ++i) {
        const double error_m_s = 0.1 + 2.0 * (2.3 - z_m) - speed_m_s;
        const double a = -0.2 + 7.5 * error_m_s + 2.7 * integral_m - 0.1 * (speed_m_s - previous_m_s) / tick_s;
        integral_m += error_m_s * tick_s;
        previous_m_s = speed_m_s;
        z_m += speed_m_s * tick_s + 0.5 * a * tick_s * tick_s;
        speed_m_s += a * tick_s;
        state = flown(model, state, reference, 1);
        REQUIRE(state.plant.q[1] == Approx(z_m).margin(1e-9));
        REQUIRE(state.plant.u[1] == Approx(speed_m_s).margin(1e-9));
        REQUIRE(std::abs(state.plant.q[2]) < 1e-9);
    }
}

TEST_CASE("the commands of a cascaded PID are its gains times its errors and nothing of the plant but its weight") {
    CascadedPid law;
    law.rotor_lead = 1;  // nothing without a lag
    law.pitch_rate_kd = 0.3;
    const FlightModel model = in_free_air(robot_with(law));
    FlightState state = model.state_at({0, 2, 0.1, 0.4}, {0.3, -0.2, 0.5, 0.6});
    CascadedPid::Memory<double> memory{{0.2, -0.1}, 0.05, -0.02, {0, 0}, 0.4};
    state.memory = controllers::remembered(memory);
    controllers::Actuation<double> given{};
    static_cast<void>(single_tick(model.tick(), state, at_rest({0.5, 2.2, 0.6}), given));

    const double ax = 1.1 * (0.75 * 0.5 - 0.3) + 0.45 * 0.2;
    const double az = 7.5 * (2.0 * 0.2 + 0.2) + 2.7 * -0.1;
    const double pitch_reference = std::atan2(ax, az + gravity);
    const double thrust_n = mass_kg * (ax * std::sin(0.1) + (az + gravity) * std::cos(0.1));
    const double torque_nm = 4.7 * (3.6 * (pitch_reference - 0.1) - 0.5) + 5.0 * 0.05 - 0.3 * (0.5 - 0.4) / tick_s;
    double sum_n = 0;
    double moment_nm = 0;
    for (int i = 0; i < 4; ++i) {
        sum_n += given.command.thrust_n[i];
        moment_nm -= (i < 2 ? 0.32 : -0.32) * given.command.thrust_n[i];
    }
    CHECK(sum_n == Approx(thrust_n).epsilon(1e-12));
    CHECK(moment_nm == Approx(torque_nm).epsilon(1e-9));
    CHECK(given.command.joint_torque_nm == Approx(10.5 * 0.2 - 2.1 * 0.6 + 5.3 * -0.02).epsilon(1e-12));
}

TEST_CASE("a cascaded PID arrives and holds, and its arm pushes it farther aside than that of a model inversion") {
    const FlightModel cascaded = in_free_air(robot_with({}));
    const FlightModel inverting = in_free_air(test_robot());
    const FlightState end = flown(cascaded, cascaded.state_at({0, 2, 0, 0.3}), at_rest({0.2, 2.2, 0.1}), 6000);
    CHECK(end.plant.q[0] == Approx(0.2).margin(1e-4));
    CHECK(end.plant.q[1] == Approx(2.2).margin(1e-4));
    CHECK(end.plant.q[2] == Approx(0).margin(1e-4));
    CHECK(end.plant.q[3] == Approx(0.1).margin(1e-4));

    double aside_m[2] = {0, 0};
    for (int which = 0; which < 2; ++which) {
        const FlightModel& model = which == 0 ? inverting : cascaded;
        FlightState state = model.state_at({0, 2, 0, quarter_turn / 3});
        for (int i = 0; i < 300; ++i) {
            state = flown(model, state, at_rest({0, 2, quarter_turn}), 1);
            aside_m[which] = std::max(aside_m[which], std::abs(state.plant.q[0]));
        }
    }
    CHECK(aside_m[1] > 1.5 * aside_m[0]);
}

TEST_CASE("the integrals of a cascaded PID stand still while a rotor is at its limit") {
    const FlightModel model = in_free_air(robot_with({}));
    const FlightState start = model.state_at({0, 2, 0, quarter_turn});
    controllers::Actuation<double> given{};
    const FlightState next = single_tick(model.tick(), start, at_rest({0, 12, quarter_turn}), given);
    REQUIRE(given.saturation > 1);
    const auto before = controllers::recalled<CascadedPid>(start.memory);
    const auto after = controllers::recalled<CascadedPid>(next.memory);
    CHECK(after.velocity_integral[1] == before.velocity_integral[1]);
    CHECK(after.rate_integral == before.rate_integral);
    CHECK(after.joint_integral == before.joint_integral);
}
