#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/mujoco_world.hpp"
#include "../support/random.hpp"
#include "../support/test_robot.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/world.hpp"

// The same vehicle, otherwise than its controller believes, in a general-purpose rigid-body simulator.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Flies a dash with a swinging arm for two seconds; MuJoCo gets the commands. @return the greatest difference of q
double difference_from_mujoco(const Robot& robot, const World& in) {
    constexpr double step_s = 1e-3;
    const double tick_s = 1 / robot.controller.rate_hz;
    const ModelInversion law = std::get<ModelInversion>(robot.controller.law);
    const simulation::TickModel model{plant_of(robot), law, tick_s};
    const FlownWorld world = make_world(robot, in);
    MujocoWorld mujoco(robot, step_s, in);
    mjData* const data = mujoco.data();
    FlightState state{};
    const double q[4] = {0.1, 1.5, 0.05, 1.2};
    std::copy(q, q + 4, state.plant.q);
    std::copy(q, q + 4, data->qpos);
    for (int i = 0; i < model.plant.rotor_count; ++i) {
        state.plant.thrust_n[i] = 0.25 * model.plant.weight_n;
        if (mujoco.model()->na > 0) {
            data->act[i] = state.plant.thrust_n[i];
        }
    }
    state.memory = controllers::remembered(ModelInversion::rested(q[2]));
    state.world = memory_at_start(world, state.plant);
    const double no_noise[simulation::noise_count] = {};
    double worst = 0;
    for (int tick = 0; tick < 200; ++tick) {
        const ReferencePoint reference{{0.8, 1.8, tick < 100 ? -1.0 : 1.6}, {0, 0, 0}, {0, 0, 0}};
        controllers::Actuation<double> given{};
        simulation::NoEffect calm;
        // Both sides step finely; the controller acts once a tick.
        const auto finely = [&](const PlantModel& plant, dynamics::PlantState<double> at,
                                const dynamics::Motion<double>&, const dynamics::PlantCommand<double>& command,
                                double dt_s, const auto& around) {
            for (int i = 0; i < 10; ++i) {
                at = dynamics::flight_step(plant, at, command, dt_s / 10, around);
            }
            return at;
        };
        FlightState next;
        simulation::tick_in_world(model, law, world.numbers, no_noise, state, reference, calm, given, next, finely);
        state = next;
        mujoco.command(given.command, model.plant.rotor_count);
        for (int i = 0; i < 10; ++i) {
            mj_step(mujoco.model(), data);
        }
        for (int i = 0; i < 4; ++i) {
            worst = std::max(worst, std::abs(state.plant.q[i] - data->qpos[i]));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("A vehicle otherwise than believed flies as in MuJoCo with the same differences") {
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.05;
    robot.arm.joint_z_m = -0.04;
    robot.rotors.time_constant_s = GENERATE(0.0, 0.05);
    if (robot.rotors.time_constant_s > 0) {  // gains that bear the lag
        gains_of(robot).attitude_kp = 4;
        gains_of(robot).attitude_rate_kp = 9;
        gains_of(robot).position_kp = 1;
    }
    CHECK(difference_from_mujoco(robot, {}) < 2e-6);
    World world;
    world.mass_scale = 0.06;
    world.arm_mass_scale = -0.1;
    world.inertia_scale = 0.12;
    CHECK(difference_from_mujoco(robot, world) < 2e-6);
    world.center_of_mass_x_m = 0.015;
    world.center_of_mass_z_m = -0.02;
    CHECK(difference_from_mujoco(robot, world) < 2e-6);
    world.thrust_scale = 0.04;
    world.rotor_thrust_scale[0] = 0.02;
    world.rotor_thrust_scale[3] = -0.03;
    if (robot.rotors.time_constant_s > 0) {
        world.rotor_time_constant_s = 0.02;
    }
    CHECK(difference_from_mujoco(robot, world) < 2e-6);
}
