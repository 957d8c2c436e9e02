#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <string>

#include "../support/mujoco_space.hpp"
#include "../support/repetitions.hpp"
#include "random_space_plant.hpp"

// The same flights in space in a general-purpose rigid-body simulator. Its free joint has our coordinates and speeds:
// velocity in world axes, angular velocity in body axes.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Thrusts that carry the vehicle and turn it a little: the least ones of all that do.
Eigen::VectorXd steering(const SpacePlant& plant, double lift_n, const Eigen::Vector3d& torque_nm) {
    Eigen::MatrixXd wrenches(4, static_cast<Eigen::Index>(plant.rotors.size()));
    Eigen::Index column = 0;
    for (const SpaceRotor& rotor : plant.rotors) {
        const Vector3 axis = (1 / std::sqrt(dot(rotor.axis, rotor.axis))) * rotor.axis;
        const Vector3 torque = cross(rotor.position_m, axis) - rotor.spin * rotor.drag_torque_m * axis;
        wrenches.col(column++) << axis[2], torque[0], torque[1], torque[2];
    }
    const Eigen::Vector4d demand(lift_n, torque_nm[0], torque_nm[1], torque_nm[2]);
    return wrenches.transpose() * (wrenches * wrenches.transpose()).inverse() * demand;
}

/// Greatest difference in a coordinate; a quaternion and its opposite are the same attitude.
template <int n>
double difference(const dynamics::SpaceState<double, n>& state, const double* q) {
    double agreement = 0;
    for (int i = 3; i < 7; ++i) {
        agreement += state.q[i] * q[i];
    }
    double worst = 0;
    for (int i = 0; i < 7 + n; ++i) {
        const double sign = i > 2 && i < 7 && agreement < 0 ? -1 : 1;
        worst = std::max(worst, std::abs(state.q[i] - sign * q[i]));
    }
    return worst;
}

/// Two seconds under commands that change every tick of 10 ms, or without any.
template <int n>
double worst_difference(std::uint64_t seed, bool is_actuated, double time_constant_s,
                        double viscous_friction_nm_s = 0) {
    constexpr double step_s = 1e-3;
    // MuJoCo's step is of the second order where a body turns about changing axes.
    constexpr int steps_of_mujoco = 20;
    Random random(seed);
    SpacePlant plant = random_space_plant(random, n);
    plant.rotor_inertia_kg_m2 = 0;
    plant.time_constant_s = time_constant_s;
    for (SpaceLink& link : plant.links) {
        link.viscous_friction_nm_s = viscous_friction_nm_s;
    }
    const SpaceModel<n> model = make_space_model<n>(plant);
    MujocoSpace world(space_mjcf(plant, step_s / steps_of_mujoco));
    mjData* const data = world.data();
    CHECK(world.model()->nv == 6 + n);
    auto state = random_space_state<n>(random, is_actuated ? 1 : 4);
    std::copy(state.q, state.q + 7 + n, data->qpos);
    std::copy(state.u, state.u + 6 + n, data->qvel);
    double worst = 0;
    for (int tick = 0; tick < 200; ++tick) {
        dynamics::SpaceCommand<double, n> command{};
        if (is_actuated) {
            // Torques that turn the vehicle and swing its joints.
            const Eigen::Vector3d torque(std::sin(0.1 * tick), std::sin(0.13 * tick), std::cos(0.05 * tick));
            const Eigen::VectorXd thrust_n = steering(plant, model.total_mass_kg * 9.8, 0.2 * torque);
            std::copy(thrust_n.begin(), thrust_n.end(), command.thrust_n);
            for (int i = 0; i < n; ++i) {
                command.joint_torque_nm[i] = 0.1 * std::cos(0.07 * tick + i) - 0.02 * state.u[6 + i];
            }
        }
        std::copy(command.joint_torque_nm, command.joint_torque_nm + n, data->ctrl);
        std::copy(command.thrust_n, command.thrust_n + model.rotor_count, data->ctrl + n);
        state = flown(model, state, command, step_s, 10);
        world.step(10 * steps_of_mujoco);
        worst = std::max(worst, difference<n>(state, data->qpos));
    }
    return worst;
}

template <int n>
void check_same_flights() {
    for (int seed = 1; seed < test::repetitions(2, 4); seed += 2) {
        CAPTURE(n, seed);
        CHECK(worst_difference<n>(seed, false, 0) < 1e-6);
        CHECK(worst_difference<n>(seed, true, 0) < 1e-6);
        CHECK(worst_difference<n>(seed, true, 0.05) < 1e-6);
    }
}

}  // namespace

TEST_CASE("In space the plant falls and flies as in MuJoCo, with arms of no, one, two and three joints") {
    check_same_flights<0>();
    check_same_flights<1>();
    check_same_flights<2>();
    check_same_flights<3>();
}

TEST_CASE("Joints with viscous friction slow down as in MuJoCo") {
    for (const std::uint64_t seed : {2U, 4U}) {
        CAPTURE(seed);
        CHECK(worst_difference<1>(seed, true, 0, 0.02) < 1e-6);
        CHECK(worst_difference<2>(seed, false, 0, 0.02) < 1e-6);
        CHECK(worst_difference<3>(seed, true, 0.05, 0.01) < 1e-6);
    }
}

TEST_CASE("The gyroscopic term of the rotors is that of flywheels that spin freely in MuJoCo") {
    // A balanced flywheel without friction keeps its speed about its axis; the multirotor feels its spin alone. What it
    // weighs and resists across its axis belongs to the multirotor, of which we take it away again.
    constexpr double step_s = 1e-4;
    constexpr double wheel_kg = 0.01;
    constexpr double wheel_kg_m2 = 4e-4;   // about its axis
    constexpr double across_kg_m2 = 2e-4;  // a thin disc
    Random random(6);
    SpacePlant plant = random_space_plant(random, 0);
    plant.rotors.resize(3);
    plant.rotor_inertia_kg_m2 = wheel_kg_m2;
    plant.thrust_coefficient_n_s2 = 1e-4;
    const double thrust_n[3] = {8, 9, 7};
    SpacePlant without_wheels = plant;
    SpaceBody& body = without_wheels.multirotor;
    std::ostringstream wheels;
    wheels << std::setprecision(17);
    for (const SpaceRotor& rotor : plant.rotors) {
        // All wheels at the centre of mass: the place of a spin does not matter, and it keeps the centre where it is.
        const Vector3 axis = (1 / std::sqrt(dot(rotor.axis, rotor.axis))) * rotor.axis;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                body.inertia_kg_m2[i][k] -= across_kg_m2 * ((i == k ? 1 : 0) - axis[i] * axis[k]);
            }
        }
        body.mass_kg -= wheel_kg;
        wheels << "<body zaxis='" << text_of(rotor.axis)
               << "'><joint type='hinge' axis='0 0 1'/><inertial pos='0 0 0' mass='" << wheel_kg << "' diaginertia='"
               << across_kg_m2 << ' ' << across_kg_m2 << ' ' << wheel_kg_m2 << "'/></body>";
    }
    MujocoSpace world(space_mjcf(without_wheels, step_s, wheels.str()));
    mjData* const data = world.data();
    const SpaceModel<0> model = make_space_model<0>(plant);
    auto state = random_space_state<0>(random, 2);
    std::copy(state.q, state.q + 7, data->qpos);
    std::copy(state.u, state.u + 6, data->qvel);
    dynamics::SpaceCommand<double, 0> command{};
    double spin = 0;
    for (int i = 0; i < 3; ++i) {
        const SpaceRotor& rotor = plant.rotors[static_cast<std::size_t>(i)];
        const Vector3 axis = (1 / std::sqrt(dot(rotor.axis, rotor.axis))) * rotor.axis;
        command.thrust_n[i] = thrust_n[i];
        data->ctrl[i] = thrust_n[i];
        // MuJoCo's joint rate is relative to the multirotor, the speed that stays is not.
        const double about_axis = dot(axis, Vector3{state.u[3], state.u[4], state.u[5]});
        const double speed = rotor.spin * std::sqrt(thrust_n[i] / plant.thrust_coefficient_n_s2);
        data->qvel[6 + i] = speed - about_axis;
        spin += wheel_kg_m2 * speed;
    }
    CHECK(std::abs(spin) > 0.05);
    double worst = 0;
    double without_term = 0;
    SpacePlant still = plant;
    still.rotor_inertia_kg_m2 = 0;
    const SpaceModel<0> still_model = make_space_model<0>(still);
    auto still_state = state;
    for (int tick = 0; tick < 100; ++tick) {
        state = flown(model, state, command, step_s, 100);
        still_state = flown(still_model, still_state, command, step_s, 100);
        world.step(100);
        worst = std::max(worst, difference<0>(state, data->qpos));
        without_term = std::max(without_term, difference<0>(still_state, data->qpos));
    }
    CHECK(worst < 1e-6);
    CHECK(without_term > 1e-2);
}
