#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/single_tick.hpp"
#include "../support/test_robot.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/control.hpp"

// The closed loop far from every surface.

using namespace downwash;
using namespace downwash::test;

namespace {

using State = simulation::State<double>;
using Given = controllers::Actuation<double>;

constexpr double degree = quarter_turn / 90;
constexpr double gravity = 9.80665;
constexpr double tick_s = 0.01;

simulation::TickModel model_of(const Robot& robot) {
    return {plant_of(robot), controllers::flown_law(robot.controller.law), 1 / robot.controller.rate_hz};
}

State resting_at(double x_m, double z_m, double arm_rad) {
    State state{};
    state.plant.q[0] = x_m;
    state.plant.q[1] = z_m;
    state.plant.q[3] = arm_rad;
    std::fill(state.plant.thrust_n, state.plant.thrust_n + 4, 4.95 * gravity / 4);
    state.memory = controllers::remembered(ModelInversion::rested(0.0));
    return state;
}

/// Every memory that the gains can have, and rotors that lag.
Robot robot_with_memory(double lag_s) {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = lag_s;
    gains_of(robot).attitude_rate_ki = 2;
    gains_of(robot).arm_ki = 4;
    gains_of(robot).rate_feed_forward = true;
    return robot;
}

State flown(const simulation::TickModel& model, State state, const ReferencePoint& reference, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        Given given{};
        state = single_tick(model, state, reference, given);
    }
    return state;
}

ModelInversion::Memory<double> memory_of(const State& state) {
    return controllers::recalled<ModelInversion>(state.memory);
}

bool same_bytes(const State& a, const State& b) {
    return is_same(a, b);
}

/// The first tick from which on a response stays within `band` of its final value.
int settling_tick(const std::vector<double>& response, double final, double band) {
    int tick = static_cast<int>(response.size());
    while (tick > 0 && std::abs(response[static_cast<std::size_t>(tick - 1)] - final) <= band) {
        --tick;
    }
    return tick;
}

/// The linear loops that the gains were chosen for, sampled and held like the real ones. A step of 1 from rest.
std::vector<double> ideal_step(double kp, double kd, double ki, int ticks) {
    const double h = tick_s;
    double q = 0;
    double u = 0;
    double integral = 0;
    std::vector<double> response;
    for (int i = 0; i < ticks; ++i) {
        response.push_back(q);
        const double v = kp * (1 - q) - kd * u + ki * integral;
        integral += (1 - q) * h;
        q += u * h + 0.5 * v * h * h;
        u += v * h;
    }
    return response;
}

std::vector<double> ideal_height(const ModelInversion& g, int ticks) {
    return ideal_step(g.position_kp, g.position_kd, g.position_ki, ticks);
}

std::vector<double> ideal_arm(const ModelInversion& g, int ticks) {
    return ideal_step(g.arm_kp, g.arm_kd, 0, ticks);
}

/// Sideways the acceleration is g times the pitch, which follows its reference with poles of its own.
std::vector<double> ideal_sideways(const ModelInversion& g, int ticks) {
    const double h = tick_s;
    double x = 0;
    double u = 0;
    double integral = 0;
    double pitch = 0;
    double rate = 0;
    double last = 0;
    double filtered = 0;
    std::vector<double> response;
    for (int i = 0; i < ticks; ++i) {
        response.push_back(x);
        const double v = g.position_kp * (1 - x) - g.position_kd * u + g.position_ki * integral;
        integral += (1 - x) * h;
        const double reference = v / gravity;
        filtered += h / (g.pitch_rate_filter_s + h) * ((reference - last) / h - filtered);
        last = reference;
        const double v5 = g.attitude_rate_kp * (filtered + g.attitude_kp * (reference - pitch) - rate);
        // Exact over a tick of constant angular acceleration.
        x += u * h + gravity * (pitch * h * h / 2 + rate * h * h * h / 6 + v5 * h * h * h * h / 24);
        u += gravity * (pitch * h + rate * h * h / 2 + v5 * h * h * h / 6);
        pitch += rate * h + 0.5 * v5 * h * h;
        rate += v5 * h;
    }
    return response;
}

/// One coordinate over a flight.
std::vector<double> response_of(const simulation::TickModel& model, State state, const ReferencePoint& reference,
                                int ticks, int coordinate) {
    std::vector<double> response;
    for (int i = 0; i < ticks; ++i) {
        response.push_back(state.plant.q[coordinate]);
        state = flown(model, state, reference, 1);
    }
    return response;
}

}  // namespace

TEST_CASE("Hover stands still for ten seconds with the arm in any direction") {
    const auto model = model_of(test_robot());
    for (const double arm : {0.0, 0.8, quarter_turn, 3.0, -quarter_turn}) {
        State state = resting_at(1, 2, arm);
        double worst = 0;
        for (int i = 0; i < 1000; ++i) {
            state = flown(model, state, at_rest({1, 2, arm}), 1);
            worst = std::max({worst, std::abs(state.plant.q[0] - 1), std::abs(state.plant.q[1] - 2),
                              std::abs(state.plant.q[2]), std::abs(state.plant.q[3] - arm)});
        }
        CHECK(worst < 1e-9);
    }
}

TEST_CASE("From 5 cm beside its place the vehicle returns as the gains foretell and holds it to 1 mm and 0.1 degrees") {
    const Robot robot = test_robot();
    const auto model = model_of(robot);
    const double arm = 0.6;
    const int expected = std::max(settling_tick(ideal_height(gains_of(robot), 6000), 1, 0.001 / 0.05),
                                  settling_tick(ideal_sideways(gains_of(robot), 6000), 1, 0.001 / 0.05));
    INFO("expected to be back after ticks: " << expected);
    State state = flown(model, resting_at(0.95, 2.05, arm), at_rest({1, 2, arm}), expected * 11 / 10);
    double worst_m = 0;
    double worst_rad = 0;
    for (int i = 0; i < 1000; ++i) {
        state = flown(model, state, at_rest({1, 2, arm}), 1);
        worst_m = std::max({worst_m, std::abs(state.plant.q[0] - 1), std::abs(state.plant.q[1] - 2)});
        worst_rad = std::max({worst_rad, std::abs(state.plant.q[2]), std::abs(state.plant.q[3] - arm)});
    }
    CHECK(worst_m < 0.001);
    CHECK(worst_rad < 0.1 * degree);
}

TEST_CASE("A step of a metre upward follows the linear loop of the gains") {
    const Robot robot = test_robot();
    const auto model = model_of(robot);
    constexpr int ticks = 3000;
    const auto ideal = ideal_height(gains_of(robot), ticks);
    const auto response = response_of(model, resting_at(0, 2, quarter_turn), at_rest({0, 3, quarter_turn}), ticks, 1);
    double worst = 0;
    for (std::size_t i = 0; i < response.size(); ++i) {
        worst = std::max(worst, std::abs(response[i] - 2 - ideal[i]));
    }
    CHECK(worst < 1e-6);
    const int expected = settling_tick(ideal, 1, 0.02);
    INFO("settles after ticks: " << expected);
    CHECK(std::abs(settling_tick(response, 3, 0.02) - expected) <= 1);
}

TEST_CASE("Steps of a metre sideways and of 60 degrees of the arm settle when the linear loops of the gains do") {
    const Robot robot = test_robot();
    const auto model = model_of(robot);
    const auto check = [](const std::vector<double>& ideal, const std::vector<double>& response, double from, double to,
                          int parts) {
        const int expected = settling_tick(ideal, 1, 0.02);
        const int settled = settling_tick(response, to, 0.02 * (to - from));
        INFO("settles after ticks: " << settled << ", expected: " << expected);
        CHECK(std::abs(settled - expected) <= expected / parts);
    };
    check(ideal_sideways(gains_of(robot), 3000),
          response_of(model, resting_at(0, 2, quarter_turn), at_rest({1, 2, quarter_turn}), 3000, 0), 0, 1, 50);
    check(ideal_arm(gains_of(robot), 1000),
          response_of(model, resting_at(0, 2, 30 * degree), at_rest({0, 2, 90 * degree}), 1000, 3), 30 * degree,
          90 * degree, 20);
}

TEST_CASE("A swing of the arm hardly moves the vehicle, because its reaction is foreseen") {
    const auto model = model_of(test_robot());
    State state = resting_at(0, 2, 30 * degree);
    double pitch = 0;
    double way_m = 0;
    for (int i = 0; i < 500; ++i) {
        state = flown(model, state, at_rest({0, 2, 90 * degree}), 1);
        pitch = std::max(pitch, std::abs(state.plant.q[2]));
        way_m = std::max({way_m, std::abs(state.plant.q[0]), std::abs(state.plant.q[1] - 2)});
    }
    INFO("pitch " << pitch / degree << " degrees, way " << way_m << " m");
    CHECK(pitch < 15 * degree);
    CHECK(way_m < 0.1);
}

TEST_CASE("A flight that is split and resumed from a copied state ends in the same bytes") {
    for (const double lag_s : {0.0, 0.012}) {
        const auto model = model_of(robot_with_memory(lag_s));
        const ReferencePoint reference = at_rest({0.2, 2.2, 0.1});
        const State start = resting_at(0, 2, 0.3);
        const State whole = flown(model, start, reference, 300);
        const State middle = flown(model, start, reference, 137);
        const State copy = middle;
        CHECK(same_bytes(flown(model, copy, reference, 163), whole));
        CHECK(whole.plant.q[0] > 0.05);  // it did fly
    }
}

TEST_CASE("Every number of the state matters to what follows") {
    // If one did not, it would be dead weight; if something else did, the flight above could not be resumed.
    const auto model = model_of(robot_with_memory(0.012));
    const ReferencePoint reference = at_rest({0.2, 2.2, 0.1});
    const State state = flown(model, resting_at(0, 2, 0.3), reference, 50);
    const State next = flown(model, state, reference, 2);
    simulation::State<bool> is_missing{};
    std::fill(is_missing.plant.thrust_n + model.plant.rotor_count, std::end(is_missing.plant.thrust_n), true);
    std::fill(is_missing.memory.number + number_count<double, ModelInversion::Memory<double>>,
              std::end(is_missing.memory.number), true);  // of other laws
    for (int i = 0; i < simulation::state_numbers; ++i) {
        State changed = state;
        set_number_at(changed, i, number_at<double>(state, i) + 1e-3);
        changed = flown(model, changed, reference, 2);
        const bool is_of_none = number_at<bool>(is_missing, i);
        if (is_of_none) {
            set_number_at(changed, i, number_at<double>(next, i));  // it is kept as it is
        }
        INFO("number " << i);
        CHECK(same_bytes(changed, next) == is_of_none);
    }
}

TEST_CASE("A demand beyond the limits is clipped, reported, and freezes the integrators") {
    Robot robot = test_robot();
    gains_of(robot).attitude_rate_ki = 2;
    gains_of(robot).arm_ki = 4;
    const auto model = model_of(robot);
    const State state = resting_at(0, 2, 0);
    Given given{};

    const State calm = single_tick(model, state, at_rest({0, 2.05, 0}), given);
    CHECK(given.saturation < 1);
    CHECK(memory_of(calm).position_integral[1] == Approx(0.05 * 0.01));

    for (const double z_m : {50.0, -50.0}) {
        const State asked = single_tick(model, state, at_rest({0, z_m, 0}), given);
        CHECK(given.saturation > 1);
        const auto [least, most] = std::minmax_element(given.command.thrust_n, given.command.thrust_n + 4);
        CHECK((z_m > 0 ? *most == 28 : *least == 0));
        CHECK(memory_of(asked).position_integral[1] == 0);
    }

    const State swung = single_tick(model, state, at_rest({0, 2, 3}), given);
    CHECK(given.saturation > 1);
    CHECK(given.command.joint_torque_nm == 12);
    CHECK(memory_of(swung).arm_integral == 0);
    CHECK(memory_of(swung).pitch_rate_integral == 0);
}

TEST_CASE("Saturation is the demand over the greatest thrust, and above one beyond either limit of a rotor") {
    const auto plant = plant_of(test_robot());
    const auto saturation = [&plant](std::array<double, max_rotors> demand_n) {
        return controllers::thrust_saturation(plant, demand_n.data());
    };
    CHECK(saturation({28.0, 28.0, 28.0, 28.0}) == 1);
    CHECK(saturation({}) == 0);
    CHECK(saturation({7.0, 3.0, 14.0, 0.0}) == 0.5);
    CHECK(saturation({1.0, 29.0, 1.0, 1.0}) == 29.0 / 28.0);
    CHECK(saturation({1.0, 1.0, 1.0, -1.0}) == 1 + 1.0 / 28.0);
    CHECK(saturation({-7.0, -1.0, -7.0, -7.0}) == 1.25);
}

TEST_CASE("hover holds with rotor lag up to 30 ms, whatever the arm's direction") {
    // The joint torque that answers a pitch torque must not come before it: a hanging arm would diverge.
    for (const double lag_s : {0.01, 0.02, 0.03}) {
        for (const double arm : {-quarter_turn, -0.8, 0.0, 0.8, quarter_turn, 3.0}) {
            CAPTURE(lag_s, arm);
            Robot robot = test_robot();
            robot.rotors.time_constant_s = lag_s;
            const State state = flown(model_of(robot), resting_at(0, 0, arm), at_rest({0.2, 0.1, arm + 0.2}), 1000);
            CHECK(std::abs(state.plant.q[0] - 0.2) < 0.02);
            CHECK(std::abs(state.plant.q[1] - 0.1) < 0.02);
            CHECK(std::abs(state.plant.q[2]) < 0.01);
            CHECK(std::abs(state.plant.q[3] - arm - 0.2) < 0.01);
        }
    }
}

TEST_CASE("The joint torque balances the thrust that lagging rotors give in the middle of the tick") {
    // Both bodies at rest, the joint at the multirotor's centre of mass, the arm at its reference: Newton and Euler for
    // an arm that is to keep its angle to the multirotor while thrust F and pitch torque T turn and lift them.
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.04;
    const simulation::TickModel model = model_of(robot);
    const double arm_rad = 0.4;
    State state = resting_at(0, 2, arm_rad);
    state.plant.thrust_n[0] *= 0.5;  // far from what will be commanded
    state.plant.thrust_n[3] *= 0.7;
    Given given{};
    static_cast<void>(single_tick(model, state, at_rest({0, 2, arm_rad}), given));
    double thrust_n = 0;
    double pitch_torque_nm = 0;
    for (int i = 0; i < 4; ++i) {
        // One implicit step of half a tick, 5 ms, towards the command: 5 / (5 + 40) of the way.
        const double reached_n =
            state.plant.thrust_n[i] + (given.command.thrust_n[i] - state.plant.thrust_n[i]) * 5 / 45;
        thrust_n += reached_n;
        pitch_torque_nm -= robot.rotors.positions_m[static_cast<std::size_t>(i)][0] * reached_n;
    }
    const double reduced_mass_kg = 4.5 * 0.45 / 4.95;
    const double inertia_kg_m2 = 0.06 + reduced_mass_kg * 0.72 * 0.72;
    const double lift_nm = -0.45 * 0.72 * std::cos(arm_rad) * thrust_n / 4.95;
    const double expected_nm = (inertia_kg_m2 * pitch_torque_nm / 0.20 + lift_nm) / (1 + inertia_kg_m2 / 0.20);
    CHECK(given.command.joint_torque_nm == Approx(expected_nm).epsilon(1e-9));
}
