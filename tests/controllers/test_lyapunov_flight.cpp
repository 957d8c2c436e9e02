#include <catch2/catch.hpp>

#include "space_vehicle.hpp"

using namespace downwash;
using namespace downwash::controllers;
using namespace downwash::test;
using State = SpaceVehicle;
using Command = SpaceThrusts;

TEST_CASE("Euler angles and their rates are those of the attitude") {
    Random random(1);
    double worst = 0;
    const SpaceModel<0> model = sample();
    for (int trial = 0; trial < 500; ++trial) {
        const EulerAngles<double> given{random.uniform(-3, 3), random.uniform(-1.4, 1.4), random.uniform(-3, 3)};
        State state = random_state(random);
        set_attitude(state, given);
        const auto angles = angles_of(state);
        worst = std::max({worst, std::abs(angles.roll - given.roll), std::abs(angles.pitch - given.pitch),
                          std::abs(angles.yaw - given.yaw)});
        set_attitude(state, {0.5 * given.roll, 0.5 * given.pitch, 0.9 * given.yaw});
        const State before = dynamics::space_step(model, state, Command{}, -1e-5, Even{1});
        const State after = dynamics::space_step(model, state, Command{}, 1e-5, Even{1});
        const auto rates = rates_of(state);
        CHECK(rates.roll == Approx((angles_of(after).roll - angles_of(before).roll) / 2e-5).margin(1e-6));
        CHECK(rates.pitch == Approx((angles_of(after).pitch - angles_of(before).pitch) / 2e-5).margin(1e-6));
        CHECK(rates.yaw == Approx((angles_of(after).yaw - angles_of(before).yaw) / 2e-5).margin(1e-6));
        // And the angular acceleration belongs to the accelerations of the angles.
        const double change = 1 / 2e-5;
        const EulerAngles<double> accelerations{change * (rates_of(after).roll - rates_of(before).roll),
                                                change * (rates_of(after).pitch - rates_of(before).pitch),
                                                change * (rates_of(after).yaw - rates_of(before).yaw)};
        const auto body = body_acceleration(euler_tilt(angles_of(state)), rates, accelerations);
        CHECK(body.x == Approx(change * (after.u[3] - before.u[3])).margin(1e-5));
        CHECK(body.y == Approx(change * (after.u[4] - before.u[4])).margin(1e-5));
        CHECK(body.z == Approx(change * (after.u[5] - before.u[5])).margin(1e-5));
    }
    CHECK(worst < 1e-14);
}

TEST_CASE("All laws together bring the vehicle to a place below a ceiling, at 100 Hz and with rotor lag") {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = 1.5;
    quadrotor.inertia_kg_m2 = {0.02, 0.024, 0.041};
    quadrotor.arm_m = 0.24;
    quadrotor.drag_torque_m = 0.016;
    quadrotor.thrust_coefficient_n_s2 = 1.1e-5;
    quadrotor.rotor_inertia_kg_m2 = 6e-5;
    quadrotor.time_constant_s = 0.02;
    const SpaceModel<0> model = make_space_model<0>(make_quadrotor(quadrotor));
    const SpaceAllocation allocation = make_space_allocation(model);
    const LyapunovLaw law;
    const auto k_c = [](double z_m) { return 1 + 0.01 / ((2 - z_m) * (2 - z_m)); };
    const RatiosInSpace surface([&](int /*rotor*/, double /*x_m*/, double /*y_m*/, double z_m) { return k_c(z_m); });
    // 0.4 m below it: nearer, the rotor that a tilt brings up draws itself up further (thesis 4.6, assumption 3.1).
    const LyapunovReference<double> reference{{1, 0, 0}, {-1, 0, 0}, {1.6, 0, 0}, {0.5, 0, 0}};
    const auto end = [&](bool knows_ceiling) {
        State state{};
        state.q[2] = 1;
        state.q[3] = 1;
        std::fill(state.thrust_n, state.thrust_n + 4, 1.5 * 9.80665 / 4);
        for (int tick = 0; tick < 1500 && state.q[2] < 1.95; ++tick) {
            Command command{};
            lyapunov_commands(model, allocation, law, state, reference, knows_ceiling ? k_c(state.q[2]) : 1.0,
                              command.thrust_n);
            for (int i = 0; i < 4; ++i) {
                command.thrust_n[i] = std::clamp(command.thrust_n[i], 0.0, 10.0);
            }
            state = dynamics::space_step(model, state, command, 0.01, surface);
        }
        return state;
    };
    const State state = end(true);
    CHECK(state.q[0] == Approx(1).margin(1e-3));
    CHECK(state.q[1] == Approx(-1).margin(1e-3));
    CHECK(state.q[2] == Approx(1.6).margin(1e-3));
    CHECK(angles_of(state).yaw == Approx(0.5).margin(1e-3));
    // Without K_c the law does not hold the height: suction draws the vehicle up.
    CHECK(end(false).q[2] > 1.85);
}

TEST_CASE("A vehicle that shall fall faster than g keeps a tenth of its weight as thrust, level and upside down") {
    const SpaceModel<0> model = sample();
    const SpaceAllocation allocation = make_space_allocation(model);
    const LyapunovReference<double> far_below{{5, 0, 0}, {-5, 0, 0}, {-100, 0, 0}, {0, 0, 0}};
    for (const double roll : {0.0, 3.1}) {
        State state{};
        set_attitude(state, {roll, 0, 0});
        double thrust_n[max_rotors] = {};
        lyapunov_commands(model, allocation, LyapunovLaw{}, state, far_below, 1.0, thrust_n);
        CHECK(thrust_n[0] + thrust_n[1] + thrust_n[2] + thrust_n[3] >= Approx(0.1 * 1.5 * 9.80665));
        CHECK(std::isfinite(thrust_n[0]));
    }
}

TEST_CASE("In space the allocation gives back what was demanded, with the least thrusts") {
    const SpaceModel<0> model = sample();
    const SpaceAllocation allocation = make_space_allocation(model);
    REQUIRE(allocation.has_full_rank);
    const double demand[4] = {15, 0.3, -0.2, 0.05};
    double thrust_n[max_rotors] = {};
    dynamics::allocate(allocation, demand, thrust_n);
    const double level[4] = {1, 0, 0, 0};
    const auto wrench = dynamics::rotor_wrench(model, dynamics::rotation_of(level), {0, 0, 0}, thrust_n, Even{1});
    CHECK(wrench.force_n.z == Approx(15));
    CHECK(wrench.torque_nm.x == Approx(0.3));
    CHECK(wrench.torque_nm.y == Approx(-0.2));
    CHECK(wrench.torque_nm.z == Approx(0.05));
    // Two rotors cannot.
    SpacePlant plant = make_quadrotor({1, {0.01, 0.01, 0.01}, 0.2});
    plant.rotors.resize(2);
    CHECK_FALSE(make_space_allocation(make_space_model<0>(plant)).has_full_rank);
}
