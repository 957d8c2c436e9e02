#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_robot.hpp"
#include "downwash/dynamics/rigid_body.hpp"
#include "random_plant.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

struct Motion {
    dynamics::Attitude<double> attitude;
    dynamics::EquationsOfMotion<double> equations;
    Motion(const PlantModel& model, const Four& q, const Four& u)
        : attitude(dynamics::attitude(model, q[2], q[3])),
          equations(dynamics::equations_of_motion(model, attitude, u.data())) {}
};

Four inverse(const PlantModel& model, const Four& q, const Four& u, const Four& du) {
    Four force{};
    dynamics::inverse_dynamics(model, Motion(model, q, u).equations, du.data(), force.data());
    return force;
}

Four forward(const PlantModel& model, const Four& q, const Four& u, const Four& force) {
    Four du{};
    dynamics::forward_dynamics(model, Motion(model, q, u).equations, force.data(), du.data());
    return du;
}

/// Column by column what the accelerations alone ask for.
std::array<Four, 4> mass_matrix(const PlantModel& model, const Four& q) {
    const Four bias = inverse(model, q, {}, {});
    std::array<Four, 4> m{};
    for (std::size_t j = 0; j < 4; ++j) {
        Four unit{};
        unit[j] = 1;
        const Four force = inverse(model, q, {}, unit);
        for (std::size_t i = 0; i < 4; ++i) {
            m[i][j] = force[i] - bias[i];
        }
    }
    return m;
}

double kinetic(const PlantModel& model, const Four& q, const Four& u) {
    return dynamics::kinetic_energy(model, Motion(model, q, u).equations, u.data());
}

/// Greatest difference relative to the greatest entry.
double difference(const Four& a, const Four& b) {
    double worst = 0;
    double size = 1;
    for (std::size_t i = 0; i < 4; ++i) {
        worst = std::max(worst, std::abs(a[i] - b[i]));
        size = std::max({size, std::abs(a[i]), std::abs(b[i])});
    }
    return worst / size;
}

}  // namespace

TEST_CASE(
    "The closed form agrees with recursive Newton-Euler for any plant and motion, and forward dynamics undoes it") {
    Random random(1);
    double worst = 0;
    double worst_undone = 0;
    for (int i = 0; i < 100'000; ++i) {
        const RandomPlant plant(random);
        const Four q = random_four(random, 7);
        const Four u = random_four(random, 5);
        const Four du = random_four(random, 20);
        const Four force = inverse(plant.model, q, u, du);
        worst = std::max(worst, difference(force, newton_euler_forces(plant.multirotor, plant.arm, q, u, du)));
        worst_undone = std::max(worst_undone, difference(forward(plant.model, q, u, force), du));
    }
    CHECK(worst < 1e-10);
    CHECK(worst_undone < 1e-9);
}

TEST_CASE("The mass matrix is symmetric, positive definite and the second difference of the kinetic energy") {
    Random random(3);
    double asymmetry = 0;
    double least_pivot = 1;
    double worst = 0;
    for (int n = 0; n < 20'000; ++n) {
        const RandomPlant plant(random);
        const Four q = random_four(random, 7);
        auto m = mass_matrix(plant.model, q);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                asymmetry = std::max(asymmetry, std::abs(m[i][j] - m[j][i]));
                Four both{}, first{}, second{};
                first[i] = 1;
                second[j] = 1;
                both[i] += 1;
                both[j] += 1;
                const double entry =
                    kinetic(plant.model, q, both) - kinetic(plant.model, q, first) - kinetic(plant.model, q, second);
                worst = std::max(worst, std::abs(entry - m[i][j]));
            }
        }
        for (std::size_t k = 0; k < 4; ++k) {  // Gauss: every pivot of a positive definite matrix is positive
            least_pivot = std::min(least_pivot, m[k][k]);
            for (std::size_t r = k + 1; r < 4; ++r) {
                const double factor = m[r][k] / m[k][k];
                for (std::size_t c = k; c < 4; ++c) {
                    m[r][c] -= factor * m[k][c];
                }
            }
        }
    }
    CHECK(asymmetry < 1e-12);
    CHECK(least_pivot > 0);
    CHECK(worst < 1e-11);
}

TEST_CASE("Kinetic and potential energy are the sums over the two bodies") {
    Random random(5);
    double kinetic_error = 0;
    double potential_error = 0;
    for (int i = 0; i < 10'000; ++i) {
        const RandomPlant plant(random);
        const Four q = random_four(random, 7);
        const Four u = random_four(random, 5);
        const double ma = plant.multirotor.mass_kg;
        const double mb = plant.arm.mass_kg;
        const double jx = plant.arm.joint_x_m;
        const double jz = plant.arm.joint_z_m;
        const double lb = plant.arm.center_of_mass_m;
        const double s = std::sin(q[2]);
        const double c = std::cos(q[2]);
        const double arm_angle = q[2] + q[3];
        const double arm_rate = u[2] + u[3];
        // d/dt of q + R(pitch) (jx, jz) + lb (cos a, -sin a)
        const double bx = u[0] + (-s * jx + c * jz) * u[2] - lb * std::sin(arm_angle) * arm_rate;
        const double bz = u[1] + (-c * jx - s * jz) * u[2] - lb * std::cos(arm_angle) * arm_rate;
        const double sum = 0.5 * ma * (u[0] * u[0] + u[1] * u[1]) +
                           0.5 * plant.multirotor.pitch_inertia_kg_m2 * u[2] * u[2] + 0.5 * mb * (bx * bx + bz * bz) +
                           0.5 * plant.arm.inertia_kg_m2 * arm_rate * arm_rate;
        kinetic_error = std::max(kinetic_error, std::abs(kinetic(plant.model, q, u) - sum));

        const double height = q[1] - s * jx + c * jz - lb * std::sin(arm_angle);
        const Motion motion(plant.model, q, u);
        potential_error =
            std::max(potential_error, std::abs(dynamics::potential_energy(plant.model, motion.attitude, q[1]) -
                                               9.80665 * (ma * q[1] + mb * height)));
    }
    CHECK(kinetic_error < 1e-10);
    CHECK(potential_error < 1e-10);
}

TEST_CASE("A level arm in hover needs the weight, its gravity torque at the joint, and the same on the vehicle") {
    const PlantModel model = plant_of(test_robot());
    const double weight_n = 4.95 * 9.80665;
    const double gravity_torque_nm = 0.45 * 9.80665 * 0.72;
    const Four force = inverse(model, {0.3, 1.2, 0, 0}, {}, {});
    CHECK(force[0] == Approx(0).margin(1e-12));
    CHECK(force[1] == Approx(weight_n));
    CHECK(force[2] == Approx(-gravity_torque_nm));            // the arm reaches forward, the rotors must lift the nose
    CHECK(force[3] == Approx(-gravity_torque_nm));            // positive torque turns the arm down
    for (const double arm : {quarter_turn, -quarter_turn}) {  // hanging or upright it needs no torque
        const Four upright = inverse(model, {0, 0, 0, arm}, {}, {});
        CHECK(upright[1] == Approx(weight_n));
        CHECK(upright[2] == Approx(0).margin(1e-12));
        CHECK(upright[3] == Approx(0).margin(1e-12));
    }
    // Level and turning at 2 rad/s it pulls outward along itself: the vehicle must be pulled back.
    const Four turning = inverse(model, {0, 0, 0, 0}, {0, 0, 0, 2}, {});
    CHECK(turning[0] == Approx(-0.45 * 0.72 * 2 * 2));
    CHECK(turning[1] == Approx(weight_n));
    CHECK(turning[3] == Approx(-gravity_torque_nm));
}

TEST_CASE("Pitch is positive nose down and the arm turns from forward over down") {
    auto robot = test_robot();
    robot.arm.joint_x_m = 0.1;
    robot.arm.joint_z_m = -0.05;
    const PlantModel model = plant_of(robot);

    const auto level = dynamics::attitude(model, 0.0, 0.0);
    const auto forward_end = dynamics::end_effector_position(model, level, 1.0, 2.0);
    CHECK(forward_end.x == Approx(1.0 + 0.1 + 1.2));
    CHECK(forward_end.z == Approx(2.0 - 0.05));

    const auto down_end =
        dynamics::end_effector_position(model, dynamics::attitude(model, 0.0, quarter_turn), 1.0, 2.0);
    CHECK(down_end.x == Approx(1.1));
    CHECK(down_end.z == Approx(1.95 - 1.2));

    // Nose straight down: the body's x axis points down, its z axis forward.
    const auto nose_down = dynamics::attitude(model, quarter_turn, 0.0);
    const auto hub = dynamics::rotor_position(model, nose_down, 1.0, 2.0, 0);
    CHECK(hub.x == Approx(1.0 + 0.06));
    CHECK(hub.z == Approx(2.0 - 0.32));
    const auto end = dynamics::end_effector_position(model, nose_down, 1.0, 2.0);
    CHECK(end.x == Approx(1.0 - 0.05));
    CHECK(end.z == Approx(2.0 - 0.1 - 1.2));
}
