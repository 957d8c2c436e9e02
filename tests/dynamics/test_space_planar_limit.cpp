#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "random_space_plant.hpp"

// With one joint across the plane of motion the plant in space is the planar one.

using namespace downwash;
using namespace downwash::test;

namespace {

/// K that differs from rotor to rotor and from place to place.
double bump(int rotor, double x_m, double z_m) {
    return 1 + (0.1 + 0.03 * rotor) * std::exp(-z_m * z_m - 0.3 * x_m * rotor);
}
const Ratios bumps(bump);
const RatiosInSpace bumps_in_space([](int rotor, double x_m, double /*y_m*/, double z_m) {
    return bump(rotor, x_m, z_m);
});

Robot planar_robot(double lag_s) {
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.11;
    robot.arm.joint_z_m = -0.07;
    robot.rotors.time_constant_s = lag_s;
    const double x_m[] = {0.31, 0.12, -0.2, -0.35};
    for (std::size_t i = 0; i < 4; ++i) {
        robot.rotors.positions_m[i] = {x_m[i], 0, 0.05 + 0.01 * static_cast<double>(i)};
    }
    return robot;
}

/// The same in space. What the plane does not know is arbitrary: inertias about other axes, and where they are tied.
SpacePlant in_space(const Robot& robot) {
    SpacePlant plant;
    plant.multirotor = {robot.multirotor.mass_kg,
                        {{{0.17, 0, 0.01}, {0, robot.multirotor.pitch_inertia_kg_m2, 0}, {0.01, 0, 0.3}}}};
    plant.links.push_back({{robot.arm.mass_kg, {{{0.001, 0, 0}, {0, robot.arm.inertia_kg_m2, 0}, {0, 0, 0.06}}}},
                           {robot.arm.joint_x_m, 0, robot.arm.joint_z_m},
                           {0, 1, 0},
                           {robot.arm.center_of_mass_m, 0, 0}});
    for (const Vector3& hub : robot.rotors.positions_m) {
        plant.rotors.push_back({hub, {0, 0, 1}, 1, 0});
    }
    plant.time_constant_s = robot.rotors.time_constant_s;
    plant.power_coefficient_w_n1p5 = robot.rotors.power_coefficient_w_n1p5;
    return plant;
}

using Planar = dynamics::PlantState<double>;
using Space = dynamics::SpaceState<double, 1>;

Space lifted(const Planar& planar) {
    Space space{{planar.q[0], 0, planar.q[1], std::cos(planar.q[2] / 2), 0, std::sin(planar.q[2] / 2), 0, planar.q[3]},
                {planar.u[0], 0, planar.u[1], 0, planar.u[2], 0, planar.u[3]},
                {},
                planar.energy_j};
    std::copy(planar.thrust_n, planar.thrust_n + max_rotors, space.thrust_n);
    return space;
}

/// Greatest difference of any coordinate, speed, thrust or energy.
double difference(const Planar& planar, const Space& space) {
    const Space other = lifted(planar);
    double worst = std::abs(space.energy_j / other.energy_j - 1);
    for (int i = 0; i < 8; ++i) {
        // The quaternion and its opposite are the same attitude.
        const double sign = i > 2 && i < 7 && space.q[3] * other.q[3] + space.q[5] * other.q[5] < 0 ? -1 : 1;
        worst = std::max(worst, std::abs(sign * space.q[i] - other.q[i]));
    }
    for (int i = 0; i < 7; ++i) {
        worst = std::max(worst, std::abs(space.u[i] - other.u[i]));
    }
    for (int i = 0; i < 4; ++i) {
        worst = std::max(worst, std::abs(space.thrust_n[i] - other.thrust_n[i]));
    }
    return worst;
}

double difference_after_a_second(double lag_s, double dt_s) {
    const Robot robot = planar_robot(lag_s);
    const PlantModel plane = plant_of(robot);
    const SpaceModel<1> space = make_space_model<1>(in_space(robot));
    Planar planar{{0.2, 0.4, 0.1, 1.2}, {0.3, 0.2, -0.4, 0.8}, {9, 10, 11, 12}, 1};
    Space lifted_state = lifted(planar);
    double worst = 0;
    const int steps = static_cast<int>(std::lround(1 / dt_s));
    for (int i = 0; i < steps; ++i) {
        const double t = i * dt_s;
        const double thrust_n[4] = {11 + std::sin(5 * t), 12.5, 12 - std::sin(7 * t), 13 + 0.5 * std::sin(3 * t)};
        dynamics::PlantCommand<double> command{};
        dynamics::SpaceCommand<double, 1> same{};
        std::copy(thrust_n, thrust_n + 4, command.thrust_n);
        std::copy(thrust_n, thrust_n + 4, same.thrust_n);
        command.joint_torque_nm = same.joint_torque_nm[0] = -2 * std::cos(4 * t);
        planar = dynamics::flight_step(plane, planar, command, dt_s, bumps);
        lifted_state = dynamics::space_step(space, lifted_state, same, dt_s, bumps_in_space);
        worst = std::max(worst, difference(planar, lifted_state));
    }
    CHECK(std::abs(planar.q[2] - 0.1) > 0.3);  // it does something
    return worst;
}

}  // namespace

TEST_CASE("In a plane the accelerations of the plant in space are the planar ones") {
    Random random(5);
    double worst = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const Robot robot = planar_robot(0);
        const PlantModel plane = plant_of(robot);
        const SpaceModel<1> space = make_space_model<1>(in_space(robot));
        Planar planar{};
        for (int i = 0; i < 4; ++i) {
            planar.q[i] = random.uniform(-3, 3);
            planar.u[i] = random.uniform(-5, 5);
            planar.thrust_n[i] = random.uniform(0, 20);
        }
        const Space state = lifted(planar);
        const double torque_nm = random.uniform(-5, 5);
        double du[4];
        dynamics::accelerations(plane, planar.q, planar.u, dynamics::motion_at(plane, planar.q, planar.u),
                                planar.thrust_n, torque_nm, bumps, du);
        double du_space[7];
        dynamics::accelerations(space, state.q, state.u, state.thrust_n, {0, 0, 0}, &torque_nm, bumps_in_space,
                                du_space);
        const double expected[] = {du[0], 0, du[1], 0, du[2], 0, du[3]};
        for (int i = 0; i < 7; ++i) {
            worst = std::max(worst, std::abs(du_space[i] - expected[i]));
        }
    }
    CHECK(worst < 1e-11);  // of up to some hundred
}

TEST_CASE("In a plane the plant in space flies as the planar one, lag and unequal surface effects included") {
    // The quaternion's four numbers are integrated, not the pitch: both differ by the error of a step. It vanishes with
    // the fourth power of the step, down to rounding.
    for (const double lag_s : {0.0, 0.05}) {
        const double coarse = difference_after_a_second(lag_s, 0.01);
        CHECK(coarse < 1e-6);
        CHECK(difference_after_a_second(lag_s, 0.005) < coarse / 12);
        CHECK(difference_after_a_second(lag_s, 0.0005) < 1e-11);
    }
}
