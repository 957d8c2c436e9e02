#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/mujoco_world.hpp"
#include "../support/test_robot.hpp"
#include "downwash/controllers/model_inversion_control.hpp"

// The same flights in a general-purpose rigid-body simulator, which knows nothing of our equations.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Checks that both plants fly alike under the same commands, for two seconds.
void check_same_flight(const Robot& robot) {
    constexpr double step_s = 1e-3;
    constexpr int steps_per_tick = 10;
    const PlantModel plant = plant_of(robot);
    MujocoWorld world(robot, step_s);
    mjData* const data = world.data();

    dynamics::PlantState<double> state{};
    const double q[4] = {0.1, 1.5, 0.05, 1.2};
    const double u[4] = {0.2, -0.1, 0.3, -0.5};
    std::copy(q, q + 4, state.q);
    std::copy(u, u + 4, state.u);
    std::copy(q, q + 4, data->qpos);
    std::copy(u, u + 4, data->qvel);

    // The controller only makes up commands, from our state: a dash sideways while the arm swings overhead and back.
    const ModelInversion law = gains_of(robot);
    auto memory = ModelInversion::rested(q[2]);
    double worst = 0;
    double greatest_pitch = 0;
    double least_arm = q[3];
    double greatest_arm = q[3];
    constexpr int ticks = 200;
    for (int tick = 0; tick < ticks; ++tick) {
        const ReferencePoint reference{{0.8, 1.8, 2 * tick < ticks ? -1.0 : 1.6}, {0, 0, 0}, {0, 0, 0}};
        const auto motion = dynamics::motion_at(plant, state.q, state.u);
        const auto control = law.demanded(plant, state, motion, memory, reference, step_s * steps_per_tick);
        memory = control.integrated;
        dynamics::PlantCommand<double> command{};
        dynamics::allocate(plant, control.demand.thrust_n, control.demand.pitch_torque_nm, command.thrust_n);
        command.joint_torque_nm = controllers::joint_torque(plant, motion, control.demand.arm_acceleration,
                                                            control.demand.thrust_n, control.demand.pitch_torque_nm);
        world.command(command, plant.rotor_count);
        for (int i = 0; i < steps_per_tick; ++i) {
            state = dynamics::flight_step(plant, state, command, step_s, FreeAir{});
            mj_step(world.model(), data);
        }
        for (int i = 0; i < 4; ++i) {
            worst = std::max(worst, std::abs(state.q[i] - data->qpos[i]));
        }
        greatest_pitch = std::max(greatest_pitch, std::abs(state.q[2]));
        least_arm = std::min(least_arm, state.q[3]);
        greatest_arm = std::max(greatest_arm, state.q[3]);
    }
    CHECK(worst < 1e-6);
    CHECK(greatest_pitch > 0.1);
    CHECK(greatest_arm - least_arm > 2);
}

}  // namespace

TEST_CASE("The plant flies as in MuJoCo under the same commands, pitching and swinging its arm") {
    Robot robot = test_robot();
    check_same_flight(robot);
    robot.arm.joint_x_m = 0.12;  // mounted beside the centre of mass
    robot.arm.joint_z_m = -0.08;
    check_same_flight(robot);
}

TEST_CASE("The plant falls and tumbles as in MuJoCo without any command") {
    constexpr double step_s = 1e-3;
    const Robot robot = test_robot();
    const PlantModel plant = plant_of(robot);
    MujocoWorld world(robot, step_s);
    dynamics::PlantState<double> state{};
    const double u[4] = {0.2, 1, 1.5, -4};
    std::copy(u, u + 4, state.u);
    std::copy(u, u + 4, world.data()->qvel);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        state = dynamics::flight_step(plant, state, dynamics::PlantCommand<double>{}, step_s, FreeAir{});
        mj_step(world.model(), world.data());
        for (int k = 0; k < 4; ++k) {
            worst = std::max(worst, std::abs(state.q[k] - world.data()->qpos[k]));
        }
    }
    CHECK(worst < 1e-6);
}
