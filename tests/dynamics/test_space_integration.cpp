#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/base/lane_pack.hpp"
#include "downwash/dynamics/space_integration.hpp"
#include "random_space_plant.hpp"

// How the plant in space is moved over a tick.

using namespace downwash;
using namespace downwash::test;

namespace {

using State = dynamics::SpaceState<double, 2>;
using Command = dynamics::SpaceCommand<double, 2>;

struct Flight {
    SpaceModel<2> model;
    State start;
    Command command{};
    explicit Flight(Random& random, double lag_s = 0.05) {
        SpacePlant plant = random_space_plant(random, 2);
        plant.time_constant_s = lag_s;
        model = make_space_model<2>(plant);
        start = random_space_state<2>(random, 1);
        for (int i = 0; i < model.rotor_count; ++i) {
            command.thrust_n[i] = 5 + i;
            start.thrust_n[i] = 4;
        }
        command.joint_torque_nm[1] = 0.1;
    }
};

bool are_same(const State& a, const State& b) {
    return std::equal(a.q, a.q + 9, b.q) && std::equal(a.u, a.u + 8, b.u) &&
           std::equal(a.thrust_n, a.thrust_n + max_rotors, b.thrust_n) && a.energy_j == b.energy_j;
}

double difference(const State& a, const State& b) {
    double worst = 0;
    for (int i = 0; i < 9; ++i) {
        worst = std::max(worst, std::abs(a.q[i] - b.q[i]));
    }
    for (int i = 0; i < 8; ++i) {
        worst = std::max(worst, std::abs(a.u[i] - b.u[i]));
    }
    return worst;
}

/// K that jumps where a hub passes a height.
const RatiosInSpace edge([](int /*rotor*/, double /*x_m*/, double /*y_m*/, double z_m) { return z_m > 0 ? 1.3 : 1.0; });

struct Wind : dynamics::CalmSpace {
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::LaneVector<double> wind() const { return {1, 2, -0.5}; }
};

}  // namespace

TEST_CASE("One step, equal steps and a disturbed step in space are what they say") {
    Random random(51);
    const Flight flight(random);
    const auto one = dynamics::space_step(flight.model, flight.start, flight.command, 0.01, FreeSpace{});
    CHECK(are_same(dynamics::OneSpaceStep{}(flight.model, flight.start, flight.command, 0.01, FreeSpace{}), one));
    CHECK(are_same(dynamics::EqualSpaceSteps{}(flight.model, flight.start, flight.command, 0.01, FreeSpace{}), one));
    CHECK(are_same(dynamics::EqualSpaceSteps{4}(flight.model, flight.start, flight.command, 0.01, FreeSpace{}),
                   flown(flight.model, flight.start, flight.command, 0.0025, 4)));
    Command added{};
    added.thrust_n[1] = 0.5;
    added.joint_torque_nm[0] = -0.2;
    Command sum = flight.command;
    sum.thrust_n[1] += 0.5;
    sum.joint_torque_nm[0] -= 0.2;
    CHECK(
        are_same(dynamics::DisturbedSpaceStep<2>{added}(flight.model, flight.start, flight.command, 0.01, FreeSpace{}),
                 dynamics::space_step(flight.model, flight.start, sum, 0.01, FreeSpace{})));
}

TEST_CASE("A smooth tick in space takes the first halves, one across an edge is refined until they agree") {
    Random random(52);
    const Flight flight(random);
    const dynamics::RefinedSpaceStep refined{};
    const auto smooth = refined(flight.model, flight.start, flight.command, 0.001, FreeSpace{});
    CHECK(are_same(smooth, flown(flight.model, flight.start, flight.command, 0.0005, 2)));

    double coarse = 0;
    double fine = 0;
    for (int trial = 0; trial < 30; ++trial) {
        Flight across(random);
        across.start.q[2] = random.uniform(-0.3, 0.3);
        across.start.u[2] = 3;
        const auto exact = flown(across.model, across.start, across.command, 0.01 / 20000, 20000, edge);
        coarse = std::max(
            coarse, difference(dynamics::space_step(across.model, across.start, across.command, 0.01, edge), exact));
        fine = std::max(fine, difference(refined(across.model, across.start, across.command, 0.01, edge), exact));
    }
    CAPTURE(coarse, fine);
    CHECK(coarse > 1e-3);
    CHECK(fine < coarse / 50);
    const dynamics::RefinedSpaceStep none{1e-7, 0};
    CHECK(are_same(none(flight.model, flight.start, flight.command, 0.01, edge),
                   flown(flight.model, flight.start, flight.command, 0.005, 2, edge)));
}

TEST_CASE("Every lane with drag, friction and stops has the bits of a flight alone, in equal steps") {
    using lane::Pack;
    Random random(53);
    SpacePlant plant = random_space_plant(random, 2);
    plant.drag = {0.2, 0.3};
    plant.end_effector_m = {0.2, 0.1, 0};
    for (SpaceLink& link : plant.links) {
        link.drag = {0.1, 0.2};
        link.viscous_friction_nm_s = 0.01;
        link.coulomb_friction_nm = 0.01;
        link.stop = JointStop{-0.1, 0.1, 20, 1};
    }
    const auto model = make_space_model<2>(plant);
    const dynamics::EqualSpaceSteps steps{dynamics::joint_steps(model, 0.01)};
    CHECK(steps.count > 1);
    dynamics::SpaceState<Pack, 2> packs{};
    dynamics::SpaceCommand<Pack, 2> commands{};
    Command command{};
    for (int i = 0; i < max_rotors; ++i) {
        command.thrust_n[i] = 4;
        commands.thrust_n[i] = Pack(4);
        packs.thrust_n[i] = Pack(0);
    }
    commands.joint_torque_nm[0] = commands.joint_torque_nm[1] = Pack(0);
    packs.energy_j = Pack(0);
    State alone[lane::pack_width];
    for (int lane = 0; lane < lane::pack_width; ++lane) {
        alone[lane] = random_space_state<2>(random, 2);
        for (int i = 0; i < 9; ++i) {
            lane::set_number(packs.q[i], lane, alone[lane].q[i]);
        }
        for (int i = 0; i < 8; ++i) {
            lane::set_number(packs.u[i], lane, alone[lane].u[i]);
        }
    }
    for (int tick = 0; tick < 20; ++tick) {
        packs = steps(model, packs, commands, Pack(0.01), Wind{});
        for (State& state : alone) {
            state = steps(model, state, command, 0.01, Wind{});
        }
    }
    for (int lane = 0; lane < lane::pack_width; ++lane) {
        for (int i = 0; i < 9; ++i) {
            CHECK(lane::number_in(packs.q[i], lane) == alone[lane].q[i]);
        }
        for (int i = 0; i < 8; ++i) {
            CHECK(lane::number_in(packs.u[i], lane) == alone[lane].u[i]);
        }
    }
}
