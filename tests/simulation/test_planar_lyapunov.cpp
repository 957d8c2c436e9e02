#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "../support/single_tick.hpp"
#include "downwash/controllers/lyapunov_coordinate.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "hover_scenes.hpp"

// The Lyapunov laws in the plane of motion, with the arm.

using namespace downwash;
using namespace downwash::test;

namespace {

Robot robot_with(const PlanarLyapunov& law) {
    Robot robot = test_robot();
    robot.controller.law = law;
    return robot;
}

struct Coordinate {
    double value, rate, acceleration;
};

/// How much faster V falls than promised [1/s], as a difference to -k e^2 - k' e'^2.
double excess_of_fall(double k, double k_rate, const Coordinate& now, const Coordinate& target) {
    const double e = now.value - target.value;
    const double de = now.rate - target.rate;
    const double e_rate = de + k * e;
    const double dv = e * de + e_rate * (now.acceleration - target.acceleration + k * de);
    return dv - (-k * e * e - k_rate * e_rate * e_rate);
}

}  // namespace

TEST_CASE(
    "V of pitch and arm falls as promised under the planar Lyapunov law, wherever and however the vehicle moves") {
    PlanarLyapunov law;
    law.pitch_k = 4;
    law.pitch_k_rate = 7;
    law.joint_k = 6;
    law.joint_k_rate = 3;
    Robot robot = robot_with(law);
    robot.rotors.max_thrust_n = 1e4;  // nothing is clipped
    robot.rotors.min_thrust_n = -1e4;
    robot.arm.max_torque_nm = 1e4;
    const FlightModel model = in_free_air(robot);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        FlightState state = model.state_at({any(random), 2 + any(random), 0.5 * any(random), 3 * any(random)},
                                           {any(random), any(random), 2 * any(random), 2 * any(random)});
        ReferencePoint reference = at_rest({any(random), 2 + any(random), 3 * any(random)});
        for (int axis = 0; axis < 3; ++axis) {
            reference.velocity[axis] = any(random);
            reference.acceleration[axis] = any(random);
        }
        controllers::Actuation<double> given{};
        const FlightState next = single_tick(model.tick(), state, reference, given);
        REQUIRE(given.saturation < 1);
        const PlantModel& plant = model.tick().plant;
        double du[4];
        dynamics::accelerations(plant, state.plant.q, state.plant.u,
                                dynamics::motion_at(plant, state.plant.q, state.plant.u), given.command.thrust_n,
                                given.command.joint_torque_nm, FreeAir{}, du);
        const auto memory = controllers::recalled<ModelInversion>(next.memory);
        const double* q = state.plant.q;
        const double* u = state.plant.u;
        CHECK(std::abs(excess_of_fall(4, 7, {q[2], u[2], du[2]},
                                      {memory.pitch_reference_rad, memory.pitch_reference_rate, 0})) < 1e-6);
        CHECK(std::abs(excess_of_fall(6, 3, {q[3], u[3], du[3]},
                                      {reference.position[2], reference.velocity[2], reference.acceleration[2]})) <
              1e-6);
    }
}

TEST_CASE("V of a height falls as promised under a level planar Lyapunov law, and its own formula says the same") {
    PlanarLyapunov law;
    law.vertical_k = 2;
    law.vertical_k_rate = 5;
    const FlightModel model = in_free_air(robot_with(law));
    FlightState state = model.state_at({0, 2.1, 0, quarter_turn}, {0, 0.3, 0, 0});
    ReferencePoint reference = at_rest({0, 2, quarter_turn});
    reference.velocity[1] = -0.1;
    reference.acceleration[1] = 0.2;
    controllers::Actuation<double> given{};
    const FlightState next = single_tick(model.tick(), state, reference, given);
    const double az = (next.plant.u[1] - 0.3) / 0.01;
    CHECK(std::abs(excess_of_fall(2, 5, {2.1, 0.3, az}, {2, -0.1, 0.2})) < 1e-6);

    const controllers::LyapunovTarget<double> target{2, -0.1, 0.2};
    const controllers::LyapunovGains gains{2, 5};
    CHECK(az == Approx(controllers::lyapunov_acceleration(
                           gains, controllers::lyapunov_errors(gains, 2.1 - 2, 0.3, target), target))
                    .epsilon(1e-9));
}

TEST_CASE("a planar Lyapunov law arrives and holds, and with an observer also beside what it does not know") {
    Robot robot = robot_with({});
    const FlightModel model = in_free_air(robot);
    const auto flown = [](const FlightModel& by, const PlantModel& plant) {
        const simulation::TickModel& tick = by.tick();
        FlightState state = by.state_at({0, 2, 0, 0.3});
        simulation::NoEffect calm;
        controllers::visit_flown(tick.law, [&](const auto& law) {
            for (int i = 0; i < 3000; ++i) {
                controllers::Actuation<double> given{};
                const auto believed = dynamics::motion_at(tick.plant, state.plant.q, state.plant.u);
                controllers::LawMemory<double> memory{};
                simulation::control(tick, law, state.plant, believed, state.memory, at_rest({0.3, 2.4, 1.1}), calm,
                                    given, memory);
                state.memory = memory;
                state.plant = dynamics::flight_step(plant, state.plant, given.command, tick.tick_s, FreeAir{});
            }
        });
        return state;
    };
    const FlightState end = flown(model, model.tick().plant);
    CHECK(end.plant.q[0] == Approx(0.3).margin(1e-6));
    CHECK(end.plant.q[1] == Approx(2.4).margin(1e-6));
    CHECK(end.plant.q[2] == Approx(0).margin(1e-6));
    CHECK(end.plant.q[3] == Approx(1.1).margin(1e-6));

    Robot heavy = robot;
    heavy.multirotor.mass_kg *= 1.1;
    const PlantModel plant = in_free_air(heavy).tick().plant;
    const FlightState low = flown(model, plant);
    // It has no integral: what is missing in the weight costs height.
    CHECK(low.plant.q[1] == Approx(2.4 - 0.45 * 9.80665 / (4.95 * (1 + 3.4 * 3.4))).margin(0.01));
    PlanarLyapunov observing;
    observing.aids.observer.emplace();
    const FlightModel with_observer = in_free_air(robot_with(observing));
    const FlightState held = flown(with_observer, plant);
    CHECK(held.plant.q[1] == Approx(2.4).margin(1e-6));
    CHECK(held.plant.q[3] == Approx(1.1).margin(1e-6));
}
