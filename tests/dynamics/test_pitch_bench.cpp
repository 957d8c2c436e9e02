#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/dynamics/pitch_bench.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "random_space_plant.hpp"

using namespace downwash;
using namespace downwash::test;
using dynamics::PitchBench;

namespace {

using State = dynamics::PitchBenchState<double>;

/// 1.5 kg, 0.02 kg m2, two of four rotors 0.25 m ahead and behind.
SpaceModel<0> sample(double lag_s = 0, double drag_torque_m = 0.02) {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = 1.5;
    quadrotor.inertia_kg_m2 = {0.03, 0.02, 0.05};
    quadrotor.arm_m = 0.25;
    quadrotor.drag_torque_m = drag_torque_m;
    quadrotor.time_constant_s = lag_s;
    quadrotor.layout = QuadrotorLayout::plus;
    return make_space_model<0>(make_quadrotor(quadrotor));
}

State flown_on_bench(const SpaceModel<0>& model, const PitchBench& bench, State state,
                     const double (&thrust_n)[max_rotors], double dt_s, int steps) {
    for (int i = 0; i < steps; ++i) {
        state = dynamics::pitch_bench_step(model, bench, state, thrust_n, dt_s, FreeSpace{});
    }
    return state;
}

}  // namespace

TEST_CASE("On the bench a plate under one rotor turns the vehicle by the thrust that it adds") {
    const auto model = sample();
    const PitchBench bench{{0, 0, 0}, {3, 4, 2}, 0};
    const double thrust_n[max_rotors] = {4, 4, 4, 4};
    // Rotor 2 of the plus layout is the front one: it gets 1.1 times its thrust.
    const RatiosInSpace plate([](int rotor, double x_m, double y_m, double z_m) {
        if (rotor == 1) {
            CHECK(x_m == Approx(3 + 0.25 * std::cos(0.2)));
            CHECK(y_m == Approx(4));
            CHECK(z_m == Approx(2 - 0.25 * std::sin(0.2)));
        }
        return rotor == 1 ? 1.1 : 1.0;
    });
    CHECK(dynamics::pitch_acceleration(model, bench, 0.2, 0.0, thrust_n, plate) == Approx(-0.25 * 0.4 / 0.02));
    const PitchBench rusty{{0, 0, 0}, {3, 4, 2}, 0.01};
    CHECK(dynamics::pitch_acceleration(model, rusty, 0.2, 5.0, thrust_n, plate) ==
          Approx((-0.25 * 0.4 - 0.01 * 5) / 0.02));
}

TEST_CASE("On an axle over its centre of mass the vehicle swings as a physical pendulum") {
    const auto model = sample();
    const PitchBench bench{{0, 0, 0.1}, {0, 0, 0}, 0};
    const double no_thrust[max_rotors] = {};
    State state{0.02, 0, {}};
    const double omega = std::sqrt(1.5 * 9.80665 * 0.1 / (0.02 + 1.5 * 0.01));
    double worst = 0;
    for (int tick = 1; tick <= 200; ++tick) {
        state = dynamics::pitch_bench_step(model, bench, state, no_thrust, 0.01, FreeSpace{});
        worst = std::max(worst, std::abs(state.pitch_rad - 0.02 * std::cos(omega * 0.01 * tick)));
    }
    CHECK(worst < 2e-5);  // the pendulum of 0.02 rad is slower by 0.02^2 / 16
}

TEST_CASE("On an axle through its centre of mass the vehicle turns as one that flies, lag included") {
    const auto model = sample(0.05, 0);  // no drag torque: in flight it would turn to yaw as well
    const PitchBench bench{{0, 0, 0}, {0, 0, 0}, 0};
    const double thrust_n[max_rotors] = {4.0, 3.9, 4, 4};
    State state{0, 0, {3, 3, 3, 3}};
    dynamics::SpaceState<double, 0> flying{{0, 0, 0, 1, 0, 0, 0}, {}, {3, 3, 3, 3}, 0};
    dynamics::SpaceCommand<double, 0> command{};
    std::copy(thrust_n, thrust_n + 4, command.thrust_n);
    for (int i = 0; i < 500; ++i) {
        state = dynamics::pitch_bench_step(model, bench, state, thrust_n, 0.001, FreeSpace{});
        flying = dynamics::space_step(model, flying, command, 0.001, FreeSpace{});
    }
    CHECK(state.pitch_rate_rad_s > 0.5);
    CHECK(state.thrust_n[1] == flying.thrust_n[1]);
    CHECK(flying.u[4] == Approx(state.pitch_rate_rad_s).epsilon(1e-12));
    CHECK(flying.q[5] == Approx(std::sin(0.5 * state.pitch_rad)).epsilon(1e-12));
}

TEST_CASE("The step on the bench converges with the fourth order") {
    const auto model = sample(0.1);
    const PitchBench bench{{0.01, 0, 0.05}, {0, 0, 1}, 0.02};
    const double thrust_n[max_rotors] = {5, 4, 4, 4};
    const auto end = [&](int steps) {
        return flown_on_bench(model, bench, {0.1, -1, {4, 4, 4, 4}}, thrust_n, 1.0 / steps, steps).pitch_rad;
    };
    const double exact = end(5120);
    CHECK(std::log2(std::abs(end(40) - exact) / std::abs(end(80) - exact)) == Approx(4).margin(0.25));
}
