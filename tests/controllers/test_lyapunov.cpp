#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/controllers/lyapunov.hpp"
#include "downwash/dynamics/quadrotor.hpp"

using namespace downwash;
using namespace downwash::controllers;
using downwash::test::Random;
using dynamics::LaneVector;
using State = dynamics::SpaceState<double, 0>;
using Command = dynamics::SpaceCommand<double, 0>;

namespace {

/// A quadrotor with spinning rotors, which follow commands at once.
SpaceModel<0> sample() {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = 1.5;
    quadrotor.inertia_kg_m2 = {0.02, 0.024, 0.041};
    quadrotor.arm_m = 0.24;
    quadrotor.drag_torque_m = 0.016;
    quadrotor.thrust_coefficient_n_s2 = 1.1e-5;
    quadrotor.rotor_inertia_kg_m2 = 6e-5;
    return make_space_model<0>(make_quadrotor(quadrotor));
}

/// The same K everywhere.
struct Even {
    double factor;
    double operator()(int /*rotor*/, double /*x_m*/, double /*y_m*/, double /*z_m*/) const { return factor; }
};

/// Yaw about z, pitch about y, roll about x: the product of three quaternions of half the angles.
void set_attitude(State& state, const EulerAngles<double>& a) {
    const double cr = std::cos(a.roll / 2);
    const double sr = std::sin(a.roll / 2);
    const double cp = std::cos(a.pitch / 2);
    const double sp = std::sin(a.pitch / 2);
    const double cy = std::cos(a.yaw / 2);
    const double sy = std::sin(a.yaw / 2);
    const double q[4] = {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                         cr * cp * sy - sr * sp * cy};
    std::copy(q, q + 4, state.q + 3);
}

EulerAngles<double> angles_of(const State& state) {
    return euler_angles(dynamics::rotation_of(state.q + 3));
}

EulerAngles<double> rates_of(const State& state) {
    return euler_rates(euler_tilt(angles_of(state)), LaneVector<double>{state.u[3], state.u[4], state.u[5]});
}

State random_state(Random& random) {
    State state{};
    for (int i = 0; i < 3; ++i) {
        state.q[i] = random.uniform(-1, 1);
        state.u[i] = random.uniform(-1, 1);
        state.u[3 + i] = random.uniform(-2, 2);
    }
    set_attitude(state, {random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-3, 3)});
    return state;
}

LyapunovTarget<double> random_target(Random& random, double around, double most) {
    return {around + random.uniform(-most, most), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// The target after a time, under its acceleration.
LyapunovTarget<double> later(const LyapunovTarget<double>& target, double t_s) {
    return {target.value + t_s * target.rate + 0.5 * t_s * t_s * target.acceleration,
            target.rate + t_s * target.acceleration, target.acceleration};
}

/// Thrusts that give a lift and what a law demands as torque. The law counts on the spin of the rotors, which follow
/// the thrusts at once: so we ask it again until both agree.
template <class Torque>
Command command_for(const SpaceModel<0>& model, double acting_n, double ceiling_factor, const Torque& torque) {
    const SpaceAllocation allocation = make_space_allocation(model);
    Command command{};
    std::fill(command.thrust_n, command.thrust_n + 4, acting_n / 4);
    for (int i = 0; i < 30; ++i) {
        lyapunov_thrusts(allocation, acting_n, torque(dynamics::rotor_spin_of(model, command.thrust_n)), ceiling_factor,
                         command.thrust_n);
    }
    return command;
}

/// dV/dt by the flight a moment earlier and later under the same command.
template <class V>
double rate_of(const SpaceModel<0>& model, const State& state, const Command& command, double ceiling_factor,
               const V& function) {
    constexpr double moment_s = 1e-5;
    const State before = dynamics::space_step(model, state, command, -moment_s, Even{ceiling_factor});
    const State after = dynamics::space_step(model, state, command, moment_s, Even{ceiling_factor});
    return (function(after, moment_s) - function(before, -moment_s)) / (2 * moment_s);
}

double decrease(const LyapunovGains& gains, const LyapunovErrors<double>& errors) {
    return gains.k * errors.e * errors.e + gains.k_rate * errors.e_rate * errors.e_rate;
}

struct AngleErrors {
    LyapunovErrors<double> roll, pitch, yaw;
    AngleErrors(const LyapunovLaw& law, const State& state, const AttitudeTarget<double>& target, double t_s = 0) {
        const auto angles = angles_of(state);
        const auto rates = rates_of(state);
        const auto errors = [&](const LyapunovGains& gains, double angle, double rate,
                                const LyapunovTarget<double>& to) {
            const auto then = later(to, t_s);
            return lyapunov_errors(gains, std::remainder(angle - then.value, 8 * std::atan(1.0)), rate, then);
        };
        roll = errors(law.roll, angles.roll, rates.roll, target.roll);
        pitch = errors(law.pitch, angles.pitch, rates.pitch, target.pitch);
        yaw = errors(law.yaw, angles.yaw, rates.yaw, target.yaw);
    }
    [[nodiscard]] double v() const {
        return lyapunov_function(roll) + lyapunov_function(pitch) + lyapunov_function(yaw);
    }
};

LyapunovLaw uneven_law() {
    LyapunovLaw law;
    law.roll = {5, 3};
    law.pitch = {4, 6};
    law.yaw = {2, 3};
    law.x = {0.7, 1.1};
    law.y = {1.2, 0.6};
    law.z = {2.5, 1.5};
    return law;
}

}  // namespace

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

TEST_CASE("Under the attitude law V falls at k e^2 + k' e'^2 of each angle, wherever the vehicle is") {
    const SpaceModel<0> model = sample();
    const LyapunovLaw law = uneven_law();
    Random random(2);
    double worst = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const State state = random_state(random);
        const AttitudeTarget<double> target{random_target(random, 0, 0.5), random_target(random, 0, 0.5),
                                            random_target(random, 0, 6)};
        const double factor = random.uniform(1, 1.6);
        const LaneVector<double> rate{state.u[3], state.u[4], state.u[5]};
        const Command command = command_for(model, 15, factor, [&](const LaneVector<double>& spin) {
            return attitude_torque(model, law, angles_of(state), rate, spin, target);
        });
        const AngleErrors errors(law, state, target);
        const double expected =
            -decrease(law.roll, errors.roll) - decrease(law.pitch, errors.pitch) - decrease(law.yaw, errors.yaw);
        const double found = rate_of(model, state, command, factor, [&](const State& at, double t_s) {
            return AngleErrors(law, at, target, t_s).v();
        });
        worst = std::max(worst, std::abs(found - expected) / std::max(1.0, std::abs(expected)));
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("Under the altitude law with K_c V falls at k e^2 + k' e'^2, and without K_c a ceiling breaks it") {
    const SpaceModel<0> model = sample();
    const LyapunovLaw law = uneven_law();
    Random random(3);
    double worst = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const State state = random_state(random);
        const auto target = random_target(random, 0, 1);
        const double factor = random.uniform(1, 1.6);
        const double up = dynamics::rotation_of(state.q + 3).third.z;
        const double acting_n = altitude_thrust(model, law, state.q[2], state.u[2], up, target);
        const Command command = command_for(model, acting_n, factor, [](const auto& /*spin*/) {
            return LaneVector<double>{0, 0, 0};
        });
        const auto errors_at = [&](const State& at, double t_s) {
            const auto then = later(target, t_s);
            return lyapunov_errors(law.z, at.q[2] - then.value, at.u[2], then);
        };
        const double found = rate_of(model, state, command, factor, [&](const State& at, double t_s) {
            return lyapunov_function(errors_at(at, t_s));
        });
        const double expected = -decrease(law.z, errors_at(state, 0));
        worst = std::max(worst, std::abs(found - expected) / std::max(1.0, std::abs(expected)));
    }
    CHECK(worst < 1e-6);
    // At hover on its target, where K is 1.3 and the law does not know, the vehicle is drawn up at 0.3 g.
    State hover{};
    hover.q[3] = 1;
    const double acting_n = altitude_thrust(model, law, 0.0, 0.0, 1.0, LyapunovTarget<double>{0, 0, 0});
    const Command command = command_for(model, acting_n, 1, [](const auto& /*spin*/) {
        return LaneVector<double>{0, 0, 0};
    });
    const State drawn = dynamics::space_step(model, hover, command, 0.01, Even{1.3});
    CHECK(drawn.u[2] == Approx(0.3 * 9.80665 * 0.01));
}

TEST_CASE("Tilted as the position law demands, V of x and y falls at k e^2 + k' e'^2") {
    const SpaceModel<0> model = sample();
    LyapunovLaw law = uneven_law();
    law.max_tilt_rad = 1.4;
    Random random(4);
    double worst = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        State state = random_state(random);
        const auto x = random_target(random, 0, 1);
        const auto y = random_target(random, 0, 1);
        const double factor = random.uniform(1, 1.6);
        const double yaw = random.uniform(-3, 3);
        const double acting_n = 25;
        const auto tilt = position_tilt(model, law, LaneVector<double>{state.q[0], state.q[1], state.q[2]},
                                        LaneVector<double>{state.u[0], state.u[1], state.u[2]}, acting_n, yaw, x, y);
        set_attitude(state, {tilt.roll_rad, tilt.pitch_rad, yaw});
        const Command command = command_for(model, acting_n, factor, [](const auto& /*spin*/) {
            return LaneVector<double>{0, 0, 0};
        });
        const auto errors_at = [&](int i, const LyapunovGains& gains, const LyapunovTarget<double>& to, const State& at,
                                   double t_s) {
            const auto then = later(to, t_s);
            return lyapunov_errors(gains, at.q[i] - then.value, at.u[i], then);
        };
        const double found = rate_of(model, state, command, factor, [&](const State& at, double t_s) {
            return lyapunov_function(errors_at(0, law.x, x, at, t_s)) +
                   lyapunov_function(errors_at(1, law.y, y, at, t_s));
        });
        const double expected =
            -decrease(law.x, errors_at(0, law.x, x, state, 0)) - decrease(law.y, errors_at(1, law.y, y, state, 0));
        worst = std::max(worst, std::abs(found - expected) / std::max(1.0, std::abs(expected)));
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("With the command of each instant V of attitude and height falls as e^(-2 k t) where k is k'") {
    const SpaceModel<0> model = sample();
    LyapunovLaw law;
    law.roll = law.pitch = law.yaw = {3, 3};
    law.z = {3, 3};
    const AttitudeTarget<double> level{{0.1, 0, 0}, {-0.1, 0, 0}, {1, 0, 0}};
    const LyapunovTarget<double> height{2, 0, 0};
    Random random(5);
    State state = random_state(random);
    const auto v_of = [&](const State& at) {
        return AngleErrors(law, at, level).v() +
               lyapunov_function(lyapunov_errors(law.z, at.q[2] - height.value, at.u[2], height));
    };
    const auto rate_at = [&](const State& at, double dq[7], double du[6]) {
        const LaneVector<double> rate{at.u[3], at.u[4], at.u[5]};
        const auto attitude = dynamics::rotation_of(at.q + 3);
        const double acting_n = altitude_thrust(model, law, at.q[2], at.u[2], attitude.third.z, height);
        const double factor = 1 + 0.05 / (3 - at.q[2]);  // of a ceiling at 3 m, the same for all rotors
        const Command command = command_for(model, acting_n, factor, [&](const LaneVector<double>& spin) {
            return attitude_torque(model, law, euler_angles(attitude), rate, spin, level);
        });
        dynamics::coordinate_rates<double, 0>(at.q, at.u, dq);
        dynamics::accelerations(model, at.q, at.u, command.thrust_n, dynamics::rotor_spin_of(model, command.thrust_n),
                                command.joint_torque_nm, Even{factor}, du);
    };
    const double first = v_of(state);
    constexpr double dt_s = 0.001;
    double worst = 0;
    for (int step = 1; step <= 2000; ++step) {
        double dq[4][7];
        double du[4][6];
        for (int stage = 0; stage < 4; ++stage) {
            State at = state;
            const double share[] = {0, 0.5, 0.5, 1};
            for (int i = 0; i < 7 && stage > 0; ++i) {
                at.q[i] += share[stage] * dt_s * dq[stage - 1][i];
            }
            for (int i = 0; i < 6 && stage > 0; ++i) {
                at.u[i] += share[stage] * dt_s * du[stage - 1][i];
            }
            rate_at(at, dq[stage], du[stage]);
        }
        for (int i = 0; i < 7; ++i) {
            state.q[i] += dt_s / 6 * (dq[0][i] + 2 * dq[1][i] + 2 * dq[2][i] + dq[3][i]);
        }
        for (int i = 0; i < 6; ++i) {
            state.u[i] += dt_s / 6 * (du[0][i] + 2 * du[1][i] + 2 * du[2][i] + du[3][i]);
        }
        worst = std::max(worst, std::abs(v_of(state) / (first * std::exp(-2 * 3 * step * dt_s)) - 1));
    }
    CHECK(worst < 1e-6);
    CHECK(state.q[2] == Approx(2).margin(0.05));
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
    const auto surface = [&](int /*rotor*/, double /*x_m*/, double /*y_m*/, double z_m) { return k_c(z_m); };
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
