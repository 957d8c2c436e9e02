#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "downwash/base/lane_pack.hpp"
#include "downwash/base/numbers.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double level[4] = {1, 0, 0, 0};

/// A body of 2 kg with one rotor, askew.
SpacePlant one_rotor() {
    SpacePlant plant;
    plant.multirotor = {2, {{{0.02, 0, 0}, {0, 0.03, 0}, {0, 0, 0.04}}}};
    plant.rotors.push_back({{0.1, 0.2, 0.3}, {0, 3, 4}, 1, 0.02});
    plant.power_coefficient_w_n1p5 = 3;
    return plant;
}

dynamics::SpaceState<double, 0> at_rest_level() {
    dynamics::SpaceState<double, 0> state{};
    state.q[3] = 1;
    return state;
}

double quaternion_length(const double* q) {
    return std::sqrt(q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6]);
}

/// One Runge-Kutta step of the quaternion alone at a constant body rate, not normalised: by how much its length is
/// off. (1 - x^2/2 + x^4/24)^2 + (x - x^3/6)^2 = 1 - x^6/72 + x^8/576 with x = rate dt / 2.
double length_error(double rate_rad_s, double dt_s) {
    const double x = 0.5 * rate_rad_s * dt_s;
    return -std::pow(x, 6) / 144;
}

}  // namespace

TEST_CASE("The wrench of a tilted rotor by hand: push, lever, drag torque against its spin") {
    const auto model = make_space_model<0>(one_rotor());
    const double thrust_n[max_rotors] = {10};
    const auto wrench = dynamics::rotor_wrench(model, dynamics::rotation_of(level), {5, 6, 7}, thrust_n,
                                               RatiosInSpace([](int rotor, double x_m, double y_m, double z_m) {
                                                   CHECK(rotor == 0);
                                                   CHECK(x_m == Approx(5.1));
                                                   CHECK(y_m == Approx(6.2));
                                                   CHECK(z_m == Approx(7.3));
                                                   return 1.5;
                                               }));
    // The axis is (0, 0.6, 0.8): 15 N act along it.
    CHECK(wrench.force_n.x == 0);
    CHECK(wrench.force_n.y == Approx(9));
    CHECK(wrench.force_n.z == Approx(12));
    // (0.1, 0.2, 0.3) x (0, 9, 12) = (-0.3, -1.2, 0.9), and 0.02 m times 10 N of free-air thrust against the axis.
    CHECK(wrench.torque_nm.x == Approx(-0.3));
    CHECK(wrench.torque_nm.y == Approx(-1.2 - 0.2 * 0.6));
    CHECK(wrench.torque_nm.z == Approx(0.9 - 0.2 * 0.8));
}

TEST_CASE("Each hub is where the attitude takes it") {
    const auto model = make_space_model<0>(one_rotor());
    const double thrust_n[max_rotors] = {1};
    // A quarter turn about z takes (0.1, 0.2, 0.3) to (-0.2, 0.1, 0.3).
    const double quarter[4] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    dynamics::rotor_wrench(model, dynamics::rotation_of(quarter), {0, 0, 0}, thrust_n,
                           RatiosInSpace([](int /*rotor*/, double x_m, double y_m, double z_m) {
                               CHECK(x_m == Approx(-0.2));
                               CHECK(y_m == Approx(0.1));
                               CHECK(z_m == Approx(0.3));
                               return 1.0;
                           }));
}

TEST_CASE("A spinning rotor makes a turning body precess") {
    SpacePlant plant = one_rotor();
    plant.rotors[0] = {{0, 0, 0}, {0, 0, 1}, 1, 0};
    plant.thrust_coefficient_n_s2 = 1e-5;
    plant.rotor_inertia_kg_m2 = 1e-4;
    const auto model = make_space_model<0>(plant);
    const double thrust_n[max_rotors] = {10};  // 1000 rad/s: 0.1 N m s upward
    const auto spin = dynamics::rotor_spin_of(model, thrust_n);
    CHECK(spin.z == Approx(0.1));
    auto state = at_rest_level();
    state.u[3] = 0.5;
    double du[6];
    const double no_torque[1] = {};
    dynamics::accelerations(model, state.q, state.u, thrust_n, spin, no_torque, FreeSpace{}, du);
    // -(0.5, 0, 0) x (0, 0, 0.1) = (0, 0.05, 0) N m.
    CHECK(du[3] == Approx(0).margin(1e-15));
    CHECK(du[4] == Approx(0.05 / 0.03));
    CHECK(du[5] == Approx(0).margin(1e-15));
    // It does no work, and the angular momentum of body and rotor is kept.
    const auto before = dynamics::invariants_at(model, state.q, state.u, spin);
    dynamics::SpaceCommand<double, 0> command{};
    command.thrust_n[0] = 10;
    state = flown(model, state, command, 0.001, 2000);
    const auto after = dynamics::invariants_at(model, state.q, state.u, spin);
    CHECK(after.angular_momentum_nm_s.x == Approx(before.angular_momentum_nm_s.x).epsilon(1e-9));
    CHECK(after.angular_momentum_nm_s.y == Approx(before.angular_momentum_nm_s.y).margin(1e-11));
    CHECK(after.angular_momentum_nm_s.z == Approx(before.angular_momentum_nm_s.z).epsilon(1e-9));
    CHECK(0.5 * (0.02 * state.u[3] * state.u[3] + 0.03 * state.u[4] * state.u[4] + 0.04 * state.u[5] * state.u[5]) ==
          Approx(0.5 * 0.02 * 0.25).epsilon(1e-9));
}

TEST_CASE("In space rotors with lag follow a step of command exponentially, and pay for what they reached") {
    SpacePlant plant = one_rotor();
    plant.time_constant_s = 0.05;
    const auto model = make_space_model<0>(plant);
    auto state = at_rest_level();
    state.thrust_n[0] = 12;
    state.thrust_n[7] = 42;  // no such rotor
    state = flown(model, state, dynamics::SpaceCommand<double, 0>{}, 0.001, 1000);
    CHECK(state.thrust_n[0] == Approx(12 * std::exp(-1 / 0.05)).margin(1e-9));
    // Integral of 3 (12 exp(-t / tau))^1.5 = 3 12^1.5 tau / 1.5.
    CHECK(state.energy_j == Approx(3 * std::pow(12.0, 1.5) * 0.05 / 1.5).epsilon(1e-6));
    CHECK(state.thrust_n[7] == 42);
}

TEST_CASE("In space joints pay for torque times the way they turned") {
    Random random(3);
    SpacePlant plant = random_space_plant(random, 2);
    plant.rotors.clear();
    const auto model = make_space_model<2>(plant);
    dynamics::SpaceState<double, 2> start{};
    start.q[3] = 1;
    dynamics::SpaceCommand<double, 2> command{};
    command.joint_torque_nm[1] = 0.05;
    const auto end = flown(model, start, command, 0.001, 100);
    CHECK(end.q[8] > 0.001);
    CHECK(end.energy_j == Approx(0.05 * end.q[8]).epsilon(1e-9));
}

TEST_CASE("A tick keeps the quaternion at length 1, and before it is brought back its length is off by x^6/144") {
    SpacePlant plant;
    plant.multirotor = {1, {{{0.02, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}}}};
    const auto model = make_space_model<0>(plant);
    // A sphere turns at a constant rate: the length of the sum of the four stages is known.
    for (const double rate_rad_s : {1.0, 10.0, 100.0}) {
        double q[7] = {0, 0, 0, 1, 0, 0, 0};
        const double u[6] = {0, 0, 0, rate_rad_s, 0, 0};
        const double dt_s = 0.01;
        double k[4][7];
        for (int stage = 0; stage < 4; ++stage) {
            double at[7];
            const double share[] = {0, 0.5, 0.5, 1};
            for (int i = 0; i < 7; ++i) {
                at[i] = q[i] + (stage > 0 ? share[stage] * dt_s * k[stage - 1][i] : 0);
            }
            dynamics::coordinate_rates<double, 0>(at, u, k[stage]);
        }
        for (int i = 0; i < 7; ++i) {
            q[i] += dt_s / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
        }
        const double error = quaternion_length(q) - 1;
        CHECK(error == Approx(length_error(rate_rad_s, dt_s)).epsilon(0.05).margin(1e-15));
    }
    auto state = at_rest_level();
    state.u[3] = 100;
    state.u[4] = -30;
    double worst = 0;
    for (int i = 0; i < 10'000; ++i) {
        state = dynamics::space_step(model, state, dynamics::SpaceCommand<double, 0>{}, 0.01, FreeSpace{});
        worst = std::max(worst, std::abs(quaternion_length(state.q) - 1));
    }
    CHECK(worst < 1e-15);
}

TEST_CASE("The step in space converges with the fourth order") {
    Random random(8);
    SpacePlant plant = random_space_plant(random, 2);
    plant.time_constant_s = 0.08;
    const auto model = make_space_model<2>(plant);
    dynamics::SpaceState<double, 2> start = random_space_state<2>(random, 1);
    dynamics::SpaceCommand<double, 2> command{};
    for (int i = 0; i < model.rotor_count; ++i) {
        command.thrust_n[i] = 4 + 0.3 * i;
        start.thrust_n[i] = 5;
    }
    command.joint_torque_nm[0] = 0.2;
    command.joint_torque_nm[1] = -0.1;
    const RatiosInSpace around([](int rotor, double x_m, double y_m, double z_m) {
        return 1 + (0.2 + 0.02 * rotor) * std::exp(-0.2 * z_m * z_m - 0.1 * x_m + 0.1 * y_m);
    });
    const auto end = [&](int steps) { return flown(model, start, command, 0.5 / steps, steps, around); };
    const auto exact = end(5120);
    const auto error = [&](int steps) {
        const auto state = end(steps);
        double worst = std::abs(state.thrust_n[0] - exact.thrust_n[0]);
        for (int i = 0; i < 9; ++i) {
            worst = std::max(worst, std::abs(state.q[i] - exact.q[i]));
        }
        for (int i = 0; i < 8; ++i) {
            worst = std::max(worst, std::abs(state.u[i] - exact.u[i]));
        }
        return worst;
    };
    CHECK(std::log2(error(80) / error(160)) == Approx(4).margin(0.25));
    CHECK(std::log2(error(160) / error(320)) == Approx(4).margin(0.25));
}

TEST_CASE("Lanes of a pack fly the same bits as plain doubles") {
    using lane::Pack;
    constexpr int width = lane::pack_width;
    Random random(21);
    SpacePlant plant = random_space_plant(random, 2);
    plant.time_constant_s = 0.05;
    const auto model = make_space_model<2>(plant);
    dynamics::SpaceCommand<double, 2> commands[width];
    dynamics::SpaceState<double, 2> states[width];
    dynamics::SpaceState<Pack, 2> pack{};
    dynamics::SpaceCommand<Pack, 2> pack_command{};
    using Numbers = dynamics::SpaceState<double, 2>;
    for (int lane = 0; lane < width; ++lane) {
        states[lane] = random_space_state<2>(random, 3);
        commands[lane] = {};
        for (int i = 0; i < model.rotor_count; ++i) {
            commands[lane].thrust_n[i] = random.uniform(2, 8);
            lane::set_number(pack_command.thrust_n[i], lane, commands[lane].thrust_n[i]);
        }
        for (int i = 0; i < 2; ++i) {
            commands[lane].joint_torque_nm[i] = random.uniform(-0.2, 0.2);
            lane::set_number(pack_command.joint_torque_nm[i], lane, commands[lane].joint_torque_nm[i]);
        }
        for (int i = 0; i < number_count<double, Numbers>; ++i) {
            Pack all = number_at<Pack>(pack, i);
            lane::set_number(all, lane, number_at<double>(states[lane], i));
            set_number_at(pack, i, all);
        }
    }
    const RatiosInSpace around([](int rotor, auto x_m, auto y_m, auto z_m) {
        using T = decltype(x_m);
        return T(1.1) + T(0.01 * rotor) * x_m / (T(1) + y_m * y_m + z_m * z_m);
    });
    for (int tick = 0; tick < 50; ++tick) {
        pack = dynamics::space_step(model, pack, pack_command, Pack(0.01), around);
        for (int lane = 0; lane < width; ++lane) {
            states[lane] = dynamics::space_step(model, states[lane], commands[lane], 0.01, around);
        }
    }
    int differing = 0;
    for (int lane = 0; lane < width; ++lane) {
        for (int i = 0; i < number_count<double, Numbers>; ++i) {
            differing += lane::number_in(number_at<Pack>(pack, i), lane) != number_at<double>(states[lane], i) ? 1 : 0;
        }
    }
    CHECK(differing == 0);
}
