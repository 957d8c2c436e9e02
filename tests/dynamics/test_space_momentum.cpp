#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/dynamics/space_momentum.hpp"
#include "random_space_plant.hpp"
#include "space_energy.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

template <int n>
void momentum_of(const SpaceModel<n>& model, const dynamics::SpaceState<double, n>& state, double (&out)[6 + n]) {
    const auto places = dynamics::places_at(model, state.q);
    dynamics::momentum(model, places, dynamics::equations_of_motion(model, places, state.u), state.u, out);
}

/// By how much the momentum misses what forces and free_momentum_rate() change it by: over two short steps of the plant
/// under a wrench and joint torques, whose difference in time is the derivative.
template <int n>
double missed(Random& random) {
    SpacePlant plant = random_space_plant(random, n);
    plant.rotor_inertia_kg_m2 = 0;
    const SpaceModel<n> model = make_space_model<n>(plant);
    const auto state = random_space_state<n>(random, 2);
    dynamics::SpaceCommand<double, n> command{};
    for (int i = 0; i < model.rotor_count; ++i) {
        command.thrust_n[i] = random.uniform(0, 8);
    }
    for (int i = 0; i < n; ++i) {
        command.joint_torque_nm[i] = random.uniform(-1, 1);
    }
    constexpr double dt_s = 1e-4;
    double before[6 + n], after[6 + n], rate[6 + n];
    momentum_of<n>(model, dynamics::space_step(model, state, command, -dt_s, FreeSpace{}), before);
    momentum_of<n>(model, dynamics::space_step(model, state, command, dt_s, FreeSpace{}), after);
    const auto places = dynamics::places_at(model, state.q);
    dynamics::free_momentum_rate(model, places, state.u, rate);
    const auto wrench = dynamics::rotor_wrench(model, places.attitude, {0, 0, 0}, command.thrust_n, FreeSpace{});
    const auto force = places.attitude * wrench.force_n;
    const double given[6] = {force.x, force.y, force.z, wrench.torque_nm.x, wrench.torque_nm.y, wrench.torque_nm.z};
    double worst = 0;
    for (int i = 0; i < 6 + n; ++i) {
        const double acting = i < 6 ? given[i] : command.joint_torque_nm[i - 6];
        const double change = (after[i] - before[i]) / (2 * dt_s);
        worst = std::max(worst, std::abs(change - rate[i] - acting));
    }
    return worst;
}

}  // namespace

TEST_CASE("The generalised momentum in space changes by forces and by what coordinates change it by") {
    Random random(4);
    double worst = 0;
    for (int trial = 0; trial < 100; ++trial) {
        worst = std::max({worst, missed<0>(random), missed<1>(random), missed<3>(random)});
    }
    CHECK(worst < 1e-4);  // of up to a hundred; the difference quotient is good to 1e-5 of its second derivative
}

TEST_CASE("Half of momentum times speeds is the kinetic energy") {
    Random random(6);
    for (int trial = 0; trial < 100; ++trial) {
        const SpaceModel<3> model = make_space_model<3>(random_space_plant(random, 3));
        const auto state = random_space_state<3>(random, 3);
        double p[9];
        momentum_of<3>(model, state, p);
        double twice_j = 0;
        for (int i = 0; i < 9; ++i) {
            twice_j += p[i] * state.u[i];
        }
        const auto all = dynamics::invariants_at(model, state.q, state.u, {0, 0, 0});
        CHECK(0.5 * twice_j == Approx(all.kinetic_j).epsilon(1e-12));
        CHECK(p[0] == Approx(all.momentum_n_s.x).epsilon(1e-12));
        CHECK(p[1] == Approx(all.momentum_n_s.y).epsilon(1e-12));
        CHECK(p[2] == Approx(all.momentum_n_s.z).epsilon(1e-12));
    }
}
