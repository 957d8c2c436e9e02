#include <catch2/catch.hpp>

#include "space_vehicle.hpp"

using namespace downwash;
using namespace downwash::controllers;
using namespace downwash::test;
using dynamics::LaneVector;
using State = SpaceVehicle;
using Command = SpaceThrusts;

namespace {

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
