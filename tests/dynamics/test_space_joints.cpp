#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/base/lane_pack.hpp"
#include "downwash/dynamics/space_integration.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"

// Friction and stops of the joints.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double base_kg_m2 = 0.04;
constexpr double link_kg_m2 = 0.01;
constexpr double mobility_1_kg_m2 = 1 / base_kg_m2 + 1 / link_kg_m2;

/// A link that turns about the common vertical axis of both bodies, against each other alone.
SpacePlant spindle() {
    SpacePlant plant;
    plant.multirotor = {2, {{{0.02, 0, 0}, {0, 0.03, 0}, {0, 0, base_kg_m2}}}};
    SpaceLink link;
    link.body = {0.3, {{{0.002, 0, 0}, {0, 0.002, 0}, {0, 0, link_kg_m2}}}};
    link.joint_m = {0, 0, -0.1};
    link.axis = {0, 0, 1};
    plant.links.push_back(link);
    return plant;
}

dynamics::SpaceState<double, 1> turning(double rate_rad_s) {
    dynamics::SpaceState<double, 1> state{};
    state.q[3] = 1;
    state.u[6] = rate_rad_s;
    return state;
}

/// Rates of the spindle after a second without commands.
double rate_after_a_second(const SpacePlant& plant, double rate_rad_s) {
    const auto model = make_space_model<1>(plant);
    return flown(model, turning(rate_rad_s), dynamics::SpaceCommand<double, 1>{}, 0.001, 1000).u[6];
}

/// All joints with friction and stops.
SpacePlant rubbing_plant(Random& random, int joints) {
    SpacePlant plant = random_space_plant(random, joints);
    plant.rotors.clear();
    plant.rotor_inertia_kg_m2 = 0;
    for (SpaceLink& link : plant.links) {
        link.viscous_friction_nm_s = random.uniform(0, 0.02);
        link.coulomb_friction_nm = random.uniform(0, 0.02);
        const double middle_rad = random.uniform(-0.3, 0.3);
        link.stop = JointStop{middle_rad - random.uniform(0.1, 0.6), middle_rad + random.uniform(0.1, 0.6), 30,
                              random.uniform(0, 1)};
    }
    return plant;
}

template <int n>
double stored_in_stops_j(const SpaceModel<n>& model, const double* q) {
    double sum_j = 0;
    for (int i = 0; i < n; ++i) {
        const auto& link = model.link[i];
        const double depth_rad = std::max({q[7 + i] - link.stop_upper_rad, link.stop_lower_rad - q[7 + i], 0.0});
        sum_j += 0.5 * link.stop_stiffness_nm_rad * depth_rad * depth_rad;
    }
    return sum_j;
}

/// @return what the stops held at most [J]
template <int n>
double check_energy_and_momentum(Random& random) {
    const auto model = make_space_model<n>(rubbing_plant(random, n));
    const int steps = dynamics::joint_steps(model, 0.01);
    auto state = random_space_state<n>(random, 3);
    for (int i = 0; i < n; ++i) {
        state.q[7 + i] *= 0.1;
    }
    const auto invariants = [&] { return dynamics::invariants_at(model, state.q, state.u, {0, 0, 0}); };
    const auto first = invariants();
    const auto energy_of = [&](const auto& all) {
        return all.kinetic_j + all.potential_j + stored_in_stops_j(model, state.q);
    };
    double before_j = energy_of(first);
    double greatest_stored_j = 0;
    for (int tick = 0; tick < 200; ++tick) {
        state = dynamics::EqualSpaceSteps{steps}(model, state, dynamics::SpaceCommand<double, n>{}, 0.01, FreeSpace{});
        const double after_j = energy_of(invariants());
        CHECK(after_j < before_j + 1e-5 * (1 + first.kinetic_j));
        before_j = after_j;
        greatest_stored_j = std::max(greatest_stored_j, stored_in_stops_j(model, state.q));
    }
    CHECK(before_j < energy_of(first) - 1e-3);
    // What acts between two bodies changes the motion of neither the whole nor its spin.
    const auto last = invariants();
    CHECK(last.momentum_n_s.x == Approx(first.momentum_n_s.x).margin(5e-5));
    CHECK(last.momentum_n_s.y == Approx(first.momentum_n_s.y).margin(5e-5));
    CHECK(last.angular_momentum_nm_s.x == Approx(first.angular_momentum_nm_s.x).margin(5e-5));
    CHECK(last.angular_momentum_nm_s.y == Approx(first.angular_momentum_nm_s.y).margin(5e-5));
    CHECK(last.angular_momentum_nm_s.z == Approx(first.angular_momentum_nm_s.z).margin(5e-5));
    return greatest_stored_j;
}

template <int n>
void check_mobility(Random& random) {
    const auto model = make_space_model<n>(random_space_plant(random, n));
    double found[n];
    dynamics::joint_mobility(model, found);
    double greatest[n] = {};
    for (int trial = 0; trial < 3000; ++trial) {
        auto state = random_space_state<n>(random, 0);
        for (int i = 0; i < n; ++i) {
            state.q[7 + i] = random.uniform(-M_PI, M_PI);
            state.u[i] = 0;
        }
        std::fill(state.u, state.u + 6 + n, 0.0);
        for (int i = 0; i < n; ++i) {
            // By a difference of two accelerations under gravity and thrust.
            double torque_nm[n] = {}, du[6 + n], more[6 + n];
            dynamics::accelerations(model, state.q, state.u, state.thrust_n, {0, 0, 0}, torque_nm, FreeSpace{}, du);
            torque_nm[i] = 1;
            dynamics::accelerations(model, state.q, state.u, state.thrust_n, {0, 0, 0}, torque_nm, FreeSpace{}, more);
            greatest[i] = std::max(greatest[i], more[6 + i] - du[6 + i]);
        }
    }
    for (int i = 0; i < n; ++i) {
        CHECK(found[i] > 0.9 * greatest[i]);
        CHECK(found[i] < 1.05 * greatest[i]);
    }
}

}  // namespace

TEST_CASE("Viscous friction slows a joint exponentially, Coulomb friction by the same amount every second") {
    SpacePlant plant = spindle();
    plant.links[0].viscous_friction_nm_s = 0.01;
    CHECK(rate_after_a_second(plant, 4) == Approx(4 * std::exp(-0.01 * mobility_1_kg_m2)).epsilon(1e-9));
    plant.links[0].viscous_friction_nm_s = 0;
    plant.links[0].coulomb_friction_nm = 0.02;
    // Above the rate at which it creeps the torque is short by (slip / rate)^2 / 2.
    const double rate_rad_s = rate_after_a_second(plant, 6);
    CHECK(rate_rad_s == Approx(6 - 0.02 * mobility_1_kg_m2).epsilon(1e-3));
    CHECK(rate_after_a_second(plant, -6) == Approx(-rate_rad_s).epsilon(1e-12));
    // And it comes to rest: from some rate on like e^(-t coulomb mobility / slip).
    CHECK(std::abs(rate_after_a_second(plant, 1)) < 1e-9);
    CHECK(rate_after_a_second(spindle(), 4) == Approx(4).epsilon(1e-12));
}

TEST_CASE("A joint that is pressed against its stop comes to rest where the spring carries the torque") {
    SpacePlant plant = spindle();
    plant.links[0].stop = JointStop{-0.5, 0.4, 50, 2};
    plant.links[0].viscous_friction_nm_s = 0.02;
    const auto model = make_space_model<1>(plant);
    const int steps = dynamics::joint_steps(model, 0.01);
    // sqrt(50 * 125) = 79 rad/s: 4 times 0.79 in a tick.
    CHECK(steps == 4);
    for (const double torque_nm : {0.5, -0.5}) {
        auto state = turning(0);
        dynamics::SpaceCommand<double, 1> command{};
        command.joint_torque_nm[0] = torque_nm;
        double farthest_rad = 0;
        for (int tick = 0; tick < 800; ++tick) {
            state = dynamics::EqualSpaceSteps{steps}(model, state, command, 0.01, FreeSpace{});
            farthest_rad = std::max(farthest_rad, torque_nm > 0 ? state.q[7] - 0.4 : -0.5 - state.q[7]);
        }
        CHECK(state.q[7] == Approx(torque_nm > 0 ? 0.4 + 0.01 : -0.5 - 0.01).epsilon(1e-6));
        CHECK(std::abs(state.u[6]) < 1e-6);
        CHECK(farthest_rad > 0.02);
        CHECK(farthest_rad < 0.15);
    }
}

TEST_CASE("A joint leaves its stop slower than it came, by what Hunt and Crossley say") {
    // For small c v the rate falls by the share 2/3 c v.
    SpacePlant plant = spindle();
    plant.links[0].stop = JointStop{-1, 0, 50, 0.01};
    const auto model = make_space_model<1>(plant);
    auto state = turning(2);
    state.q[7] = -0.1;
    state = flown(model, state, dynamics::SpaceCommand<double, 1>{}, 0.0005, 400);
    CHECK(state.q[7] < 0);
    CHECK(-state.u[6] / 2 == Approx(1 - 2.0 / 3 * 0.01 * 2).epsilon(1e-3));
    // Without damping it loses nothing.
    plant.links[0].stop->dissipation_s_rad = 0;
    auto elastic = turning(2);
    elastic.q[7] = -0.1;
    elastic = flown(make_space_model<1>(plant), elastic, dynamics::SpaceCommand<double, 1>{}, 0.0001, 2000);
    CHECK(elastic.u[6] == Approx(-2).epsilon(1e-5));
}

TEST_CASE("Friction and stops only take energy, and change neither momentum nor spin") {
    Random random(11);
    double stored_j = 0;
    for (int trial = 0; trial < 20; ++trial) {
        CAPTURE(trial);
        stored_j += check_energy_and_momentum<1>(random);
        stored_j += check_energy_and_momentum<2>(random);
        stored_j += check_energy_and_momentum<3>(random);
    }
    CHECK(stored_j > 1);
}

TEST_CASE("How easily joints give way is known over all their angles") {
    Random random(12);
    for (int trial = 0; trial < 5; ++trial) {
        check_mobility<1>(random);
        check_mobility<2>(random);
        check_mobility<3>(random);
    }
}

TEST_CASE("Stops that are never reached change no bit, and a tick without friction and stops is one step") {
    Random random(13);
    SpacePlant plant = random_space_plant(random, 2);
    const auto model = make_space_model<2>(plant);
    CHECK(dynamics::joint_steps(model, 0.01) == 1);
    CHECK(dynamics::joint_steps(make_space_model<0>(random_space_plant(random, 0)), 0.01) == 1);
    for (SpaceLink& link : plant.links) {
        link.stop = JointStop{-50, 50, 1, 1};
    }
    const auto stopped = make_space_model<2>(plant);
    CHECK(stopped.has_stops);
    const auto start = random_space_state<2>(random, 2);
    dynamics::SpaceCommand<double, 2> command{};
    command.joint_torque_nm[0] = 0.1;
    const auto with = flown(stopped, start, command, 0.01, 100);
    const auto without = flown(model, start, command, 0.01, 100);
    CHECK(std::equal(with.q, with.q + 9, without.q));
    CHECK(std::equal(with.u, with.u + 8, without.u));
}
