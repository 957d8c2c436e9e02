#include <catch2/catch.hpp>
#include <cmath>

#include "../support/repetitions.hpp"
#include "downwash/dynamics/ceiling_tick.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"

// The platform of thesis 4.3: 1.5 kg, rotors 0.24 m from the centre, guards of 0.28 m that reach 4 cm over the rotors.

using namespace downwash;
using namespace downwash::test;
using dynamics::CeilingContact;
using State = dynamics::SpaceState<double, 0>;
using Command = dynamics::SpaceCommand<double, 0>;

namespace {

constexpr double mass_kg = 1.5;
constexpr double guard_height_m = 0.05;
constexpr double ceiling_m = 2;

SpaceModel<0> sample() {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = mass_kg;
    quadrotor.inertia_kg_m2 = {0.02, 0.02, 0.035};
    quadrotor.arm_m = 0.24;
    quadrotor.rotor_height_m = 0.01;
    quadrotor.drag_torque_m = 0.016;
    return make_space_model<0>(make_quadrotor(quadrotor));
}

CeilingContact guards() {
    CeilingContact contact;
    contact.ceiling_m = ceiling_m;
    const double half = 0.24 * std::sqrt(0.5);
    for (const double x : {half, -half}) {
        for (const double y : {half, -half}) {
            dynamics::add_ring(contact, {x, y, guard_height_m}, 0.14, 4);
        }
    }
    return contact;
}

/// Only one point over each rotor.
CeilingContact four_points() {
    CeilingContact contact = guards();
    contact.point_count = 0;
    const double half = 0.24 * std::sqrt(0.5);
    for (const double x : {half, -half}) {
        for (const double y : {half, -half}) {
            contact.point_m[contact.point_count++] = {x, y, guard_height_m};
        }
    }
    return contact;
}

State level_at(double gap_m, double up_m_s) {
    State state{};
    state.q[2] = ceiling_m - guard_height_m - gap_m;
    state.q[3] = 1;
    state.u[2] = up_m_s;
    return state;
}

double energy_of(const SpaceModel<0>& model, const State& state) {
    const auto all = dynamics::invariants_at(model, state.q, state.u, {0, 0, 0});
    return all.kinetic_j + all.potential_j;
}

Command lift(double newton) {
    Command command{};
    std::fill(command.thrust_n, command.thrust_n + 4, newton / 4);
    return command;
}

/// Suction: thesis (2.18)'s kind of rise towards the ceiling.
struct Suction : FreeSpace {
    [[nodiscard]] double thrust_ratio(int /*rotor*/, const dynamics::LaneVector<double>& hub_m,
                                      const dynamics::LaneVector<double>& /*axis*/) const {
        const double distance_m = ceiling_m - hub_m.z;
        return 1 + 0.0008 / (distance_m * distance_m);
    }
};

struct Flight {
    State state;
    double impulse_n_s = 0;
    double max_depth_m = 0;
    int steps = 0;
};

template <class Around>
Flight flown_under(const SpaceModel<0>& model, const CeilingContact& contact, const State& start,
                   const Command& command, int ticks, const Around& around, double step_share = 1) {
    Flight flight{start};
    for (int i = 0; i < ticks; ++i) {
        const auto tick = dynamics::contact_tick(model, contact, flight.state, command, 0.01, around, step_share);
        flight.state = tick.state;
        flight.impulse_n_s += tick.normal_impulse_n_s;
        flight.max_depth_m = std::max(flight.max_depth_m, tick.max_depth_m);
        flight.steps += tick.steps;
    }
    return flight;
}

/// A vehicle that comes at the ceiling, tilted and turning, its highest point 2 mm below.
State random_approach(const CeilingContact& contact, Random& random) {
    State state{};
    const Eigen::Quaterniond attitude = Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(random.uniform(-0.25, 0.25), Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(random.uniform(-0.25, 0.25), Eigen::Vector3d::UnitX());
    const double q[7] = {0, 0, 0, attitude.w(), attitude.x(), attitude.y(), attitude.z()};
    std::copy(q, q + 7, state.q);
    for (int i = 0; i < 2; ++i) {
        state.u[i] = random.uniform(-0.5, 0.5);
        state.u[3 + i] = random.uniform(-0.5, 0.5);
    }
    state.u[2] = random.uniform(0.2, 0.5);
    state.u[5] = random.uniform(-1, 1);
    const auto load = dynamics::ceiling_load(contact, state.q, state.u, dynamics::rotation_of(state.q + 3));
    state.q[2] = ceiling_m - 0.002 - load.highest_m;
    return state;
}

}  // namespace

TEST_CASE("Without losses four points bounce as one spring of the textbook") {
    const auto model = sample();
    CeilingContact contact = four_points();
    contact.dissipation_s_m = 0;
    contact.friction = 0;
    const Command hover = lift(mass_kg * 9.80665);
    const Flight flight = flown_under(model, contact, level_at(0.002, 0.5), hover, 3, FreeSpace{});
    CHECK(flight.max_depth_m == Approx(0.5 * std::sqrt(mass_kg / 4e5)).epsilon(0.005));
    CHECK(flight.impulse_n_s == Approx(2 * mass_kg * 0.5).epsilon(0.005));
    CHECK(flight.state.u[2] == Approx(-0.5).epsilon(1e-4));
}

TEST_CASE("Random impacts gain no energy, and go no deeper than 2 mm") {
    const auto model = sample();
    const CeilingContact contact = guards();
    Random random(31);
    double greatest_gain_j = -1;
    double deepest_m = 0;
    int impacts = 0;
    const int wanted = test::repetitions(200, 1000);
    for (int trial = 0; trial < 3 * wanted && impacts < wanted; ++trial) {
        const State state = random_approach(contact, random);
        const Flight flight = flown_under(model, contact, state, Command{}, 20, FreeSpace{});
        if (flight.impulse_n_s > 0) {  // gravity may have turned it back before
            ++impacts;
            deepest_m = std::max(deepest_m, flight.max_depth_m);
            greatest_gain_j = std::max(greatest_gain_j, energy_of(model, flight.state) - energy_of(model, state));
        }
    }
    CHECK(impacts == wanted);
    CHECK(greatest_gain_j < 0);
    CHECK(deepest_m < 0.002);
}

TEST_CASE("Pressed against the ceiling with twice its weight the vehicle comes to rest less than 2 mm deep") {
    const auto model = sample();
    const CeilingContact contact = guards();
    Random random(32);
    double deepest_m = 0;
    double fastest = 0;
    for (int trial = 0; trial < test::repetitions(5, 20); ++trial) {
        const Flight flight =
            flown_under(model, contact, random_approach(contact, random), lift(2 * mass_kg * 9.80665), 300, Suction{});
        deepest_m = std::max(deepest_m, flight.max_depth_m);
        for (const double speed : flight.state.u) {
            fastest = std::max(fastest, std::abs(speed));
        }
    }
    CHECK(deepest_m < 0.002);
    CHECK(fastest < 0.01);
}

TEST_CASE("At rest under suction the vehicle stays at rest") {
    const auto model = sample();
    const CeilingContact contact = guards();
    // A command of 0.9 of the weight, which suction at 4 cm makes 1.35 of it: the rest presses 16 springs.
    const Command command = lift(0.9 * mass_kg * 9.80665);
    State state = level_at(0, 0);
    double depth_m = 0;
    for (int i = 0; i < 50; ++i) {  // the depth at which springs, suction and weight balance
        state.q[2] = ceiling_m - guard_height_m + depth_m;
        const double push_n =
            0.9 * mass_kg * 9.80665 * Suction{}.thrust_ratio(0, {0, 0, state.q[2] + 0.01}, {0, 0, 1}) -
            mass_kg * 9.80665;
        depth_m = push_n / (16 * contact.stiffness_n_m);
    }
    const State start = state;
    const Flight flight = flown_under(model, contact, start, command, 500, Suction{});
    for (int i = 0; i < 7; ++i) {
        CHECK(flight.state.q[i] == Approx(start.q[i]).margin(1e-12));
    }
    for (const double speed : flight.state.u) {
        CHECK(std::abs(speed) < 1e-10);
    }
    CHECK(flight.impulse_n_s == Approx(5 * 16 * contact.stiffness_n_m * depth_m).epsilon(1e-6));
}

TEST_CASE("Half the step changes the impulse of an impact by less than one per cent") {
    const auto model = sample();
    const CeilingContact contact = guards();
    Random random(33);
    double worst = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const State start = random_approach(contact, random);
        // Over 0.6 s, which may hold several impacts.
        const Flight probe = flown_under(model, contact, start, lift(0.5 * mass_kg * 9.80665), 60, Suction{});
        if (probe.impulse_n_s == 0) {
            continue;
        }
        const Flight finer = flown_under(model, contact, start, lift(0.5 * mass_kg * 9.80665), 60, Suction{}, 0.5);
        worst = std::max(worst, std::abs(finer.impulse_n_s / probe.impulse_n_s - 1));
        CHECK(finer.steps > probe.steps);
    }
    CHECK(worst < 0.01);
}

TEST_CASE("A vehicle that slides along the ceiling is slowed by Coulomb friction to a stop") {
    const auto model = sample();
    CeilingContact contact = guards();
    contact.friction = 0.1;
    // Guards so low that friction turns nothing.
    for (int i = 0; i < contact.point_count; ++i) {
        contact.point_m[i].z = 0;
    }
    const double push_n = 3;
    State start = level_at(0, 0);
    start.q[2] = ceiling_m + push_n / (16 * contact.stiffness_n_m);
    start.u[0] = 0.5;
    const Command command = lift(mass_kg * 9.80665 + push_n);
    const Flight sliding = flown_under(model, contact, start, command, 100, FreeSpace{});
    CHECK(sliding.state.u[0] == Approx(0.5 - 0.1 * push_n / mass_kg * 1).epsilon(0.01));
    const Flight later = flown_under(model, contact, sliding.state, command, 300, FreeSpace{});
    CHECK(later.state.u[0] >= 0);
    CHECK(later.state.u[0] < 1e-4);
}

TEST_CASE("Far from the ceiling a tick is one step, near it as many as contact needs") {
    const auto model = sample();
    const CeilingContact contact = guards();
    const Command command = lift(mass_kg * 9.80665);
    CHECK(dynamics::contact_tick(model, contact, level_at(0.1, 0.5), command, 0.01, FreeSpace{}).steps == 1);
    const auto near = dynamics::contact_tick(model, contact, level_at(0.004, 0.5), command, 0.01, FreeSpace{});
    CHECK(near.steps > 10);
    CHECK(near.steps < 1000);
    CHECK(near.normal_impulse_n_s > 0);
}
