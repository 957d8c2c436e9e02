#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "random_plant.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

using Command = dynamics::PlantCommand<double>;
using State = dynamics::PlantState<double>;

State state_of(const double (&q)[4], const double (&u)[4] = {0, 0, 0, 0}) {
    State state{};
    std::copy(q, q + 4, state.q);
    std::copy(u, u + 4, state.u);
    return state;
}

PlantModel model_with_lag(double time_constant_s) {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = time_constant_s;
    return plant_of(robot);
}

/// All rotors alike.
Command even_command(const PlantModel& model, double thrust_n, double joint_torque_nm) {
    Command command{};
    std::fill(command.thrust_n, command.thrust_n + model.rotor_count, thrust_n / model.rotor_count);
    command.joint_torque_nm = joint_torque_nm;
    return command;
}

State flown(const PlantModel& model, State state, const Command& command, double dt_s, int steps) {
    for (int i = 0; i < steps; ++i) {
        state = dynamics::flight_step(model, state, command, dt_s, FreeAir{});
    }
    return state;
}

/// What a motion without forces keeps; the vertical momentum changes by the weight alone.
struct Invariants {
    double energy, kinetic, momentum_x, momentum_z, spin;  // spin: angular momentum about the common centre of mass
    Invariants(const PlantModel& model, const State& s) {
        const auto a = dynamics::attitude(model, s.q[2], s.q[3]);
        const auto e = dynamics::equations_of_motion(model, a, s.u);
        kinetic = dynamics::kinetic_energy(model, e, s.u);
        energy = kinetic + dynamics::potential_energy(model, a, s.q[1]);
        // Of the arm's centre of mass, relative to the multirotor's.
        const double x = a.joint_x + model.arm_center_of_mass_m * a.arm_x;
        const double z = a.joint_z + model.arm_center_of_mass_m * a.arm_z;
        const double vx = e.pitch_x * s.u[2] + e.arm_x * s.u[3];
        const double vz = e.pitch_z * s.u[2] + e.arm_z * s.u[3];
        momentum_x = model.total_mass_kg * s.u[0] + model.arm_mass_kg * vx;
        momentum_z = model.total_mass_kg * s.u[1] + model.arm_mass_kg * vz;
        spin = model.pitch_inertia_kg_m2 * s.u[2] + model.arm_inertia_kg_m2 * (s.u[2] + s.u[3]) +
               model.reduced_mass_kg * (z * vx - x * vz);  // about +y
    }
};

/// du/dt in free air with all rotors at the commanded thrust.
struct Accelerations {
    double u[4];
    Accelerations(const PlantModel& model, const State& state, const Command& command) {
        dynamics::accelerations(model, state.q, state.u, dynamics::motion_at(model, state.q, state.u), command.thrust_n,
                                command.joint_torque_nm, FreeAir{}, u);
    }
};

constexpr double weight_n = 4.95 * 9.80665;

}  // namespace

TEST_CASE("Ten seconds without forces keep energy, momentum and spin") {
    // At the control tick of 10 ms; the drift is of the order of 1e-9.
    for (const double offset_m : {0.0, 0.15}) {
        Robot robot = test_robot();
        robot.arm.joint_x_m = offset_m;
        robot.arm.joint_z_m = -offset_m;
        const PlantModel model = plant_of(robot);
        State state = state_of({0, 0, 0.3, 0.8}, {0.5, 2, 1.5, -4});
        const Invariants first(model, state);
        double energy_drift = 0;
        for (int i = 0; i < 10; ++i) {
            state = flown(model, state, Command{}, 0.01, 100);
            energy_drift = std::max(energy_drift, std::abs(Invariants(model, state).energy - first.energy));
        }
        const Invariants last(model, state);
        CHECK(energy_drift / first.kinetic < 1e-6);
        CHECK(last.momentum_x == Approx(first.momentum_x).epsilon(1e-9));
        CHECK(last.momentum_z == Approx(first.momentum_z - 10 * model.total_mass_kg * standard_gravity_m_s2));
        CHECK(last.spin == Approx(first.spin).epsilon(1e-6));
    }
}

TEST_CASE(
    "Without thrust the manipulator falls along the parabola of the textbook, with that of its weight it hovers") {
    const PlantModel model = plant_of(test_robot());
    const State state = flown(model, state_of({1, 50, 0.2, 0.7}, {0.5, 1, 0, 0}), Command{}, 0.01, 200);
    CHECK(state.q[0] == Approx(1 + 0.5 * 2));
    CHECK(state.q[1] == Approx(50 + 1 * 2 - 0.5 * 9.80665 * 4));
    CHECK(state.q[2] == Approx(0.2));
    CHECK(state.q[3] == Approx(0.7));
    CHECK(state.u[1] == Approx(1 - 9.80665 * 2));
    const State start = state_of({1, 2, 0, quarter_turn});
    const State hovering = flown(model, start, even_command(model, weight_n, 0), 0.01, 100);
    for (int i = 0; i < 4; ++i) {
        CHECK(hovering.q[i] == Approx(start.q[i]).margin(1e-9));
        CHECK(hovering.u[i] == Approx(0).margin(1e-9));
    }
}

TEST_CASE("Accelerations by hand: one front rotor that lifts more, a pitched body, a step of joint torque") {
    const PlantModel model = plant_of(test_robot());
    Command command = even_command(model, weight_n, 0);
    command.thrust_n[0] += 1;
    const Accelerations rate(model, state_of({0, 2, 0, quarter_turn}), command);
    CHECK(rate.u[1] == Approx(1 / 4.95));
    CHECK(rate.u[2] == Approx(-0.32 * 1 / 0.20));  // the hanging arm pulls through the centre of mass
    // Pitch and arm angle change together: the arm stays hanging.
    CHECK(rate.u[3] == Approx(0.32 * 1 / 0.20));
    // Thrust acts along the body's axis.
    const double pitch = 0.4;
    const State state = state_of({0, 2, pitch, quarter_turn - pitch});
    const Accelerations pitched(model, state, even_command(model, 60, 0));
    // Vertical pull goes through the hanging arm's centre of mass: the whole mass rises; sideways the arm swings.
    CHECK(pitched.u[1] == Approx(60 * std::cos(pitch) / 4.95 - 9.80665));
    const double swung_mass_kg = 4.5 + 0.45 * 0.06 / (0.06 + 0.45 * 0.72 * 0.72);
    CHECK(pitched.u[0] == Approx(60 * std::sin(pitch) / swung_mass_kg));
    CHECK(pitched.u[2] == Approx(0).margin(1e-9));
    // A step of joint torque swings the arm and pushes the vehicle the other way round.
    const Accelerations swung(model, state_of({0, 2, 0, quarter_turn}), even_command(model, weight_n, 1));
    // The arm's absolute angular acceleration: torque about a joint that the vehicle's mass holds back sideways.
    const double reduced_kg = 4.5 * 0.45 / 4.95;
    CHECK(swung.u[2] + swung.u[3] == Approx(1 / (0.06 + reduced_kg * 0.72 * 0.72)));
    CHECK(swung.u[2] == Approx(-1 / 0.20));
}

TEST_CASE("Allocation is the pseudo-inverse for any layout, centred or not") {
    Random random(1);
    double wrench_error = 0;
    double least_squares_error = 0;
    for (int n = 0; n < 10'000; ++n) {
        const RandomPlant plant(random);
        const PlantModel& model = plant.model;
        const auto [rear, front] = std::minmax_element(model.rotor_x_m, model.rotor_x_m + model.rotor_count);
        if (*front - *rear < 1e-3) {  // no layout that robot_errors() accepts
            continue;
        }
        const double thrust_n = random.uniform(0, 100);
        const double torque_nm = random.uniform(-10, 10);
        double share[max_rotors] = {};
        dynamics::allocate(model, thrust_n, torque_nm, share);
        double sum = 0;
        double torque = 0;
        double size = 1;
        for (int i = 0; i < model.rotor_count; ++i) {
            sum += share[i];
            torque -= model.rotor_x_m[i] * share[i];
            size = std::max(size, std::abs(share[i]));
        }
        wrench_error = std::max({wrench_error, std::abs(sum - thrust_n) / size, std::abs(torque - torque_nm) / size});
        // Of all solutions the least-squares one is a combination of the rows: T_i is linear in x_i.
        int second = 1;
        for (int i = 2; i < model.rotor_count; ++i) {
            if (std::abs(model.rotor_x_m[i] - model.rotor_x_m[0]) >
                std::abs(model.rotor_x_m[second] - model.rotor_x_m[0])) {
                second = i;
            }
        }
        const double slope = (share[second] - share[0]) / (model.rotor_x_m[second] - model.rotor_x_m[0]);
        for (int i = 0; i < model.rotor_count; ++i) {
            const double on_line = share[0] + slope * (model.rotor_x_m[i] - model.rotor_x_m[0]);
            least_squares_error = std::max(least_squares_error, std::abs(share[i] - on_line) / size);
        }
    }
    CHECK(wrench_error < 1e-9);
    CHECK(least_squares_error < 1e-9);
    // In a symmetric layout each rotor takes its part of the thrust and its lever's part of the torque.
    const PlantModel model = plant_of(test_robot());
    double share[max_rotors] = {};
    dynamics::allocate(model, 40.0, 3.0, share);
    for (int i = 0; i < 4; ++i) {
        CHECK(share[i] == Approx(40.0 / 4 - model.rotor_x_m[i] * 3.0 / (4 * 0.32 * 0.32)));
    }
}

TEST_CASE("Rotors with lag follow a step of command exponentially, those without lag at once") {
    const PlantModel model = model_with_lag(0.05);
    const Command command = even_command(model, 40, 0);
    State state = state_of({0, 100, 0, quarter_turn});
    double worst = 0;
    for (int tick = 1; tick <= 50; ++tick) {
        state = dynamics::flight_step(model, state, command, 0.01, FreeAir{});
        worst = std::max(worst, std::abs(state.thrust_n[2] - 10 * (1 - std::exp(-0.01 * tick / 0.05))));
    }
    CHECK(worst < 1e-4);  // of 10 N; the step of a fifth of the time constant costs 6e-5

    // Velocity from thrust that builds up: integral of L / m - g.
    const double lost_s = 0.05 * (1 - std::exp(-0.5 / 0.05));
    CHECK(state.u[1] == Approx(40 / 4.95 * (0.5 - lost_s) - 9.80665 * 0.5).epsilon(1e-5));
    const PlantModel without_lag = plant_of(test_robot());
    const Command at_once = even_command(without_lag, 40, 0);
    const State after_a_step = flown(without_lag, state_of({0, 9, 0, quarter_turn}), at_once, 0.01, 1);
    CHECK(after_a_step.thrust_n[3] == 10);
    CHECK(after_a_step.u[1] == Approx((40 / 4.95 - 9.80665) * 0.01));
}

TEST_CASE("Rotor energy is the power of the commanded thrust, whatever a surface makes of it") {
    const PlantModel model = plant_of(test_robot());
    const Command command = even_command(model, 48, 0);
    const double power_w = 2.9 * 4 * std::pow(12.0, 1.5);
    CHECK(dynamics::rotor_power(model, command.thrust_n) == Approx(power_w));
    State state = state_of({0, 9, 0, quarter_turn});
    for (int i = 0; i < 100; ++i) {
        state = dynamics::flight_step(model, state, command, 0.01, Ratios([](int, double, double) { return 1.3; }));
    }
    CHECK(state.energy_j == Approx(power_w * 1.0));
}

TEST_CASE("Rotor energy with lag is the power of the thrust that the lag has reached") {
    const auto after_a_cut = [](double time_constant_s, double step_s, int steps) {
        const PlantModel model = model_with_lag(time_constant_s);
        State state = state_of({0, 99, 0, quarter_turn});
        std::fill(state.thrust_n, state.thrust_n + 4, 12.0);
        return flown(model, state, even_command(model, 0, 0), step_s, steps);
    };
    // Integral of (12 exp(-t / tau))^1.5 = 12^1.5 tau / 1.5.
    CHECK(after_a_cut(0.05, 0.001, 1000).energy_j == Approx(2.9 * 4 * std::pow(12.0, 1.5) * 0.05 / 1.5).epsilon(1e-6));
    // A lag shorter than the step leaves a finite energy.
    const State state = after_a_cut(0.006, 0.01, 1);
    CHECK(std::isfinite(state.energy_j));
    CHECK(state.thrust_n[0] > 0);
    CHECK(state.thrust_n[0] < 6);
}

TEST_CASE("Arm energy is the torque times the way it turned") {
    const PlantModel model = plant_of(test_robot());
    const State start = state_of({0, 9, 0, 0});
    for (const double torque_nm : {2.0, -2.0}) {
        const State end = flown(model, start, even_command(model, 0, torque_nm), 0.01, 30);
        CHECK(end.energy_j == Approx(2 * std::abs(end.q[3])));
    }
}

TEST_CASE("A surface factor multiplies each rotor's thrust at its own place") {
    const PlantModel model = plant_of(test_robot());
    const double thrust_n[max_rotors] = {10, 11, 12, 13};
    const double pitch = 0.3;
    const auto a = dynamics::attitude(model, pitch, 0.0);
    std::vector<int> asked;
    const Ratios around([&](int rotor, double x_m, double z_m) {
        asked.push_back(rotor);
        const double bx = model.rotor_x_m[rotor];
        CHECK(x_m == Approx(5 + std::cos(pitch) * bx + std::sin(pitch) * 0.06));
        CHECK(z_m == Approx(2 - std::sin(pitch) * bx + std::cos(pitch) * 0.06));
        return bx > 0 ? 1.5 : 1.0;
    });
    const auto wrench = dynamics::rotor_wrench(model, a, 5.0, 2.0, thrust_n, around);
    CHECK(asked == std::vector<int>{0, 1, 2, 3});
    CHECK(wrench.thrust_n == Approx(1.5 * 21 + 25));
    CHECK(wrench.pitch_torque_nm == Approx(-0.32 * (1.5 * 21 - 25)));
}

TEST_CASE("A fountain pushes the body along its axis at the centre between the rotors") {
    Robot robot = test_robot();
    for (Vector3& hub_m : robot.rotors.positions_m) {
        hub_m[0] += 0.05;  // the centre between the rotors lies ahead of the centre of mass
    }
    const PlantModel calm = make_plant_model(robot.multirotor, robot.arm, robot.rotors);
    const PlantModel model = make_plant_model(robot.multirotor, robot.arm, robot.rotors, true);
    const double thrust_n[max_rotors] = {10, 11, 12, 13};
    const double pitch = -0.2;
    const auto a = dynamics::attitude(model, pitch, 0.0);
    struct Fountain : FreeAir {
        double pitch;
        explicit Fountain(double at_pitch) : pitch(at_pitch) {}
        double thrust_ratio(int /*rotor*/, const dynamics::PlanePoint<double>& /*hub_m*/, double /*sin_pitch*/) const {
            return 1.1;
        }
        double body_ratio(const dynamics::PlanePoint<double>& center_m, double /*sin_pitch*/) const {
            CHECK(center_m.x == Approx(5 + std::cos(pitch) * 0.05 + std::sin(pitch) * 0.06));
            CHECK(center_m.z == Approx(2 - std::sin(pitch) * 0.05 + std::cos(pitch) * 0.06));
            return 1.25;
        }
    };
    const Fountain around(pitch);
    const auto without = dynamics::rotor_wrench(calm, a, 5.0, 2.0, thrust_n, around);
    const auto with = dynamics::rotor_wrench(model, a, 5.0, 2.0, thrust_n, around);
    CHECK(with.thrust_n - without.thrust_n == Approx(0.25 * 46));
    CHECK(with.pitch_torque_nm - without.pitch_torque_nm == Approx(-0.05 * 0.25 * 46));
}

TEST_CASE("The surface factor is read at every stage of a step, not held") {
    // K = 1 - b (z - z0) under a thrust of the weight is a spring: z oscillates with omega^2 = g b. A factor held over
    // the step would turn this into growing oscillations of the first order in the step.
    const PlantModel model = plant_of(test_robot());
    const Command command = even_command(model, weight_n, 0);
    const double omega = std::sqrt(9.80665 * 0.5);
    State state = state_of({0, 2.1, 0, quarter_turn});
    double worst = 0;
    for (int tick = 1; tick <= 500; ++tick) {
        state = dynamics::flight_step(model, state, command, 0.01,
                                      Ratios([](int, double, double z_m) { return 1 - 0.5 * (z_m - 2.06); }));
        worst = std::max(worst, std::abs(state.q[1] - (2 + 0.1 * std::cos(omega * 0.01 * tick))));
    }
    CHECK(worst < 1e-7);
}

TEST_CASE("The step converges with the fourth order") {
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.1;
    robot.rotors.time_constant_s = 0.08;
    const PlantModel model = plant_of(robot);
    Command command = even_command(model, 55, 1.5);
    command.thrust_n[0] += 0.5;
    const Ratios around([](int, double x_m, double z_m) { return 1 + 0.3 * std::exp(-z_m * z_m - x_m); });
    const auto end = [&](int steps) {
        State state = state_of({0.2, 0.5, 0.1, 0.4}, {0.3, 0.1, -0.5, 1});
        for (int i = 0; i < steps; ++i) {
            state = dynamics::flight_step(model, state, command, 0.8 / steps, around);
        }
        return state;
    };
    const State exact = end(5120);
    const auto error = [&](int steps) {
        const State state = end(steps);
        double worst = std::abs(state.thrust_n[0] - exact.thrust_n[0]);
        for (int i = 0; i < 4; ++i) {
            worst = std::max({worst, std::abs(state.q[i] - exact.q[i]), std::abs(state.u[i] - exact.u[i])});
        }
        return worst;
    };
    CHECK(std::log2(error(40) / error(80)) == Approx(4).margin(0.25));
    CHECK(std::log2(error(80) / error(160)) == Approx(4).margin(0.25));
}

TEST_CASE("Rotors are alike while they give the same thrust and have the same command") {
    const double thrust_n[] = {3, 3, 4, 3, 4, 3};
    const double command_n[] = {5, 5, 5, 6, 5, 5};
    const auto alike = dynamics::alike_rotors(6, thrust_n, command_n);
    const int expected[] = {0, 0, 2, 3, 2, 0};
    CHECK(std::equal(expected, expected + 6, alike.as));
    const double none[] = {std::nan(""), std::nan("")};
    CHECK(dynamics::alike_rotors(2, none, command_n).as[1] == 1);
}

TEST_CASE("A rotor's thrust and power do not depend on whether another one is alike") {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.02;
    const PlantModel model = plant_of(robot);
    State state = state_of({0.2, 0.5, 0.1, 0.4}, {0.3, 0.1, -0.5, 1});
    Command command = even_command(model, 50, 0);
    const double thrust_n[] = {11, 11, 12, 12};
    const double command_n[] = {13, 13, 10.5, 10.5};
    std::copy(thrust_n, thrust_n + 4, state.thrust_n);
    std::copy(command_n, command_n + 4, command.thrust_n);
    const auto stepped = [&] { return dynamics::flight_step(model, state, command, 0.01, FreeAir{}); };
    const State alike = stepped();
    CHECK(alike.thrust_n[0] == alike.thrust_n[1]);
    CHECK(alike.thrust_n[2] == alike.thrust_n[3]);
    // The same rotors in another order, and with other partners.
    std::swap(state.thrust_n[1], state.thrust_n[2]);
    std::swap(command.thrust_n[1], command.thrust_n[2]);
    const State crossed = stepped();
    CHECK(crossed.thrust_n[0] == alike.thrust_n[0]);
    CHECK(crossed.thrust_n[1] == alike.thrust_n[2]);
    CHECK(crossed.energy_j == Approx(alike.energy_j).epsilon(1e-14));
    state.thrust_n[2] = 20;
    const State alone = stepped();
    CHECK(alone.thrust_n[0] == alike.thrust_n[0]);
    CHECK(alone.thrust_n[3] == alike.thrust_n[3]);
    CHECK(alone.thrust_n[2] != alike.thrust_n[0]);
    CHECK(alone.energy_j > alike.energy_j);
}

TEST_CASE("A step is a pure function and leaves what it does not know alone") {
    const PlantModel model = plant_of(test_robot());
    State state = state_of({0.2, 0.5, 0.1, 0.4}, {0.3, 0.1, -0.5, 1});
    state.thrust_n[7] = 42;  // no such rotor
    const Command command = even_command(model, 50, 1);
    const State one = dynamics::flight_step(model, state, command, 0.01, FreeAir{});
    const State two = dynamics::flight_step(model, state, command, 0.01, FreeAir{});
    CHECK(std::equal(one.q, one.q + 4, two.q));
    CHECK(std::equal(one.u, one.u + 4, two.u));
    CHECK(one.energy_j == two.energy_j);
    CHECK(one.thrust_n[7] == 42);
}
