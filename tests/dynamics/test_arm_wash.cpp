#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/random.hpp"
#include "../support/washed_robot.hpp"
#include "downwash/dynamics/arm_wash.hpp"

// The slipstreams of the rotors on the arm.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double radius_m = 0.1905;

double speed(double depth, double away) {
    return dynamics::slipstream_speed(depth, away * away);
}

/// Sum of a function over [0, end] by the midpoint rule.
template <class Of>
double sum_over(double end, const Of& of) {
    constexpr int pieces = 20000;
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        sum += of((i + 0.5) / pieces * end) * end / pieces;
    }
    return sum;
}

struct Load {
    double force[4] = {};
};

Load wash_of(const Robot& robot, const double (&q)[4], const double (&u)[4], const std::vector<double>& thrust_n,
             double scale = 1) {
    const PlantModel plant = plant_of(robot);
    Load load;
    dynamics::WashedVehicle<double> vehicle{
        dynamics::attitude(plant, q[2], q[3]), {u[0], u[1], u[2], u[3]}, {0, 0}, {}, scale};
    std::copy(thrust_n.begin(), thrust_n.end(), vehicle.acting_n);
    dynamics::add_arm_wash(plant, slipstreams_of(robot.arm, robot.rotors), vehicle, load.force);
    return load;
}

/// The same with a fine sum, in world axes, by the virtual work of each piece of the arm, for rotors without mirrored
/// ones.
Load fine_wash_of(const Robot& robot, const double (&q)[4], const double (&u)[4], const std::vector<double>& thrust_n) {
    const PlantModel plant = plant_of(robot);
    const double disc_m2 = M_PI * robot.rotors.radius_m * robot.rotors.radius_m;
    const auto point_at = [&](const double(&at)[4], double s) {
        const auto a = dynamics::attitude(plant, at[2], at[3]);
        return dynamics::PlanePoint<double>{at[0] + a.joint_x + s * a.arm_x, at[1] + a.joint_z + s * a.arm_z};
    };
    constexpr int pieces = 4000;
    Load load;
    for (int n = 0; n < pieces; ++n) {
        const double s = (n + 0.5) / pieces * robot.arm.length_m;
        dynamics::PlanePoint<double> by_q[4];  // dP/dq by differences
        for (int i = 0; i < 4; ++i) {
            double above[4], below[4];
            std::copy(q, q + 4, above);
            std::copy(q, q + 4, below);
            above[i] += 1e-5;
            below[i] -= 1e-5;
            const auto p = point_at(above, s);
            const auto m = point_at(below, s);
            by_q[i] = {(p.x - m.x) / 2e-5, (p.z - m.z) / 2e-5};
        }
        dynamics::PlanePoint<double> velocity{0, 0};
        for (int i = 0; i < 4; ++i) {
            velocity.x += by_q[i].x * u[i];
            velocity.z += by_q[i].z * u[i];
        }
        const double across[2] = {-std::sin(q[2] + q[3]), -std::cos(q[2] + q[3])};
        const double up[2] = {std::sin(q[2]), std::cos(q[2])};
        const auto here = point_at(q, s);
        for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
            const Vector3& hub = robot.rotors.positions_m[i];
            const double hub_x = q[0] + std::cos(q[2]) * hub[0] + std::sin(q[2]) * hub[2];
            const double hub_z = q[1] - std::sin(q[2]) * hub[0] + std::cos(q[2]) * hub[2];
            const double depth = (hub_x - here.x) * up[0] + (hub_z - here.z) * up[1];
            const double ahead = (hub_x - here.x) * up[1] - (hub_z - here.z) * up[0];
            const double away = std::sqrt(ahead * ahead + hub[1] * hub[1]);
            const double v = std::sqrt(thrust_n[i] / (2 * 1.225 * disc_m2)) * speed(depth / radius_m, away / radius_m);
            const auto drag = [&](double c) {
                return (robot.arm.drag.linear_n_s_m + robot.arm.drag.quadratic_n_s2_m2 * std::abs(c)) * c / pieces;
            };
            const double still = velocity.x * across[0] + velocity.z * across[1];
            const double washed = (velocity.x + v * up[0]) * across[0] + (velocity.z + v * up[1]) * across[1];
            const double f = drag(still) - drag(washed);
            for (int k = 0; k < 4; ++k) {
                load.force[k] += f * (across[0] * by_q[k].x + across[1] * by_q[k].z);
            }
        }
    }
    return load;
}

}  // namespace

TEST_CASE("An arm in the middle of a slipstream is pushed as a calculation by hand has it") {
    Robot robot = test_robot();
    // A short level arm below the front rotor, three quarters of a radius below the disc: 3, 4 and 5 make a triangle.
    robot.rotors.radius_m = 0.2;
    robot.rotors.positions_m = {{0.45, 0, 0.1}, {-0.45, 0, 0.1}};
    robot.arm.joint_x_m = 0.40;
    robot.arm.joint_z_m = -0.05;
    robot.arm.length_m = 0.1;
    robot.arm.center_of_mass_m = 0.05;
    robot.arm.drag = {0, 0.05};
    robot.arm.wash.emplace();
    // A = 0.125664 m2, so that 12 N give 6.2432 m/s at the disc, and 1 + 3/5 times that where the arm is: 9.9891 m/s.
    // Its drag is 0.05 * 9.9891^2 = 4.9891 N, downwards, half way along the arm.
    const Load load = wash_of(robot, {0, 2, 0, 0}, {0, 0, 0, 0}, {12, 12});
    CHECK(load.force[0] == Approx(0).margin(1e-12));
    CHECK(load.force[1] == Approx(-4.9891).epsilon(1e-4));
    CHECK(load.force[2] == Approx(4.9891 * 0.45).epsilon(1e-4));
    CHECK(load.force[3] == Approx(4.9891 * 0.05).epsilon(1e-4));
    // It falls with the air at half that speed: a quarter of the force is left; the drag without a wash pushes up.
    const Load falling = wash_of(robot, {0, 2, 0, 0}, {0, -9.9891 / 2, 0, 0}, {12, 12});
    const double drag_n = 0.05 * 9.9891 * 9.9891 / 4;
    CHECK(falling.force[1] + drag_n == Approx(-drag_n).epsilon(1e-4));
    // Half as much speed again, and 2.25 times the force.
    CHECK(wash_of(robot, {0, 2, 0, 0}, {0, 0, 0, 0}, {12, 12}, 1.5).force[1] == Approx(-2.25 * 4.9891).epsilon(1e-4));
    robot.arm.wash->scale = 1.5;
    CHECK(wash_of(robot, {0, 2, 0, 0}, {0, 0, 0, 0}, {12, 12}).force[1] == Approx(-2.25 * 4.9891).epsilon(1e-4));
    // Hanging, it is in a stream along it, which has no force.
    CHECK(wash_of(robot, {0, 2, 0, quarter_turn}, {0, 0, 0, 0}, {12, 12}).force[3] == Approx(0).margin(1e-9));
}

TEST_CASE("A slipstream carries the momentum that its rotor has given it") {
    // Per v_i^2 and pi R^2 it is half of the thrust at the disc and all of it far below, whatever the layer does.
    for (const double depth : {0.0, 0.5, 1.0, 2.0, 4.0, 5.5, 6.0, 8.0, 12.0, 30.0}) {
        CAPTURE(depth);
        const double flux = sum_over(20, [&](double r) { return 2 * r * std::pow(speed(depth, r), 2); });
        const double gain = 1 + depth / std::sqrt(1 + depth * depth);
        CHECK(flux / 2 == Approx(gain / 2).epsilon(1e-3));
    }
}

TEST_CASE("A slipstream has no step and no kink, but for the core's end and the disc") {
    constexpr double h = 1e-7;
    for (double depth = 0.05; depth < 10; depth += 0.37) {
        for (double r = 0.01; r < 4; r += 0.0137) {
            // Where the layer begins or ends, too: a kink would leave a difference of slopes of the order of 1.
            const double slopes = (speed(depth, r + h) - 2 * speed(depth, r) + speed(depth, r - h)) / h;
            CHECK(std::abs(slopes) < 0.02);
        }
    }
    for (const double r : {0.0, 0.5, 0.9, 1.1}) {
        for (const double depth : {-0.5, 0.0, 6.0 - 1 / 24.0}) {
            CHECK(std::abs(speed(depth + h, r) - speed(depth - h, r)) < 1e-5);
        }
    }
    CHECK(speed(-0.51, 0) == 0);
    CHECK(speed(1e6, 1e7) == 0);
    CHECK(speed(-1e6, 0) == 0);
}

TEST_CASE("Nothing moves beyond the bound within which the arm is looked at") {
    for (double depth = -0.5; depth < 200; depth += 0.01) {
        CHECK(speed(depth, dynamics::edge_radii + dynamics::edge_spread * depth) == 0);
    }
}

TEST_CASE("A slipstream pushes a bar across it as one that was measured, within a quarter") {
    // W. Khan and M. Nahon, Development and validation of a propeller slipstream model for unmanned aerial vehicles,
    // Journal of Aircraft 52 (2015) 1985: fits to small propellers in static air, from 1.53 radii on. A hub of a tenth.
    const double v0 = 2 * 1.46 / 1.59;
    const double x0 = 1.528, r0 = 0.74, d0 = 2 * r0, m0 = 0.67 * (r0 - 0.1);
    const auto measured = [&](double x, double r) {
        const double way = (x - x0) / d0;
        const double peak = x < 1.7 * d0 ? 1.24 - 0.0765 * way : 1.37 - 0.1529 * way;
        const double at = x < 1.7 * d0 ? m0 * (1 - 0.1294 * way) : m0 * (1.3 - 0.3059 * way);
        const double width = x < 1.7 * d0 ? 0.8839 * m0 + 0.1326 * (x - x0 - r0) : 0.5176 * m0 + 0.2295 * (x - x0 - r0);
        return v0 * peak * std::exp(-std::pow((r - at) / width, 2));
    };
    double sum = 0, sum_measured = 0;
    for (const double depth : {2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0}) {
        CAPTURE(depth);
        const double ours = sum_over(4, [&](double r) { return std::pow(speed(depth, r), 2); });
        const double theirs = sum_over(4, [&](double r) { return std::pow(measured(depth, r), 2); });
        CHECK(ours == Approx(theirs).epsilon(0.25));
        sum += ours;
        sum_measured += theirs;
    }
    CHECK(sum == Approx(sum_measured).epsilon(0.05));
}

TEST_CASE("The points along the arm are enough: a fine sum of virtual work differs by 3 % of the largest load") {
    for (const double x_m : {0.45, 0.25}) {
        for (const double y_m : {0.0, 0.12}) {
            for (const double length_m : {0.5, 1.2}) {
                CAPTURE(x_m, y_m, length_m);
                Robot robot = test_robot();
                robot.rotors.positions_m = {{x_m, y_m, 0.06}, {-x_m, 0, 0.06}};
                robot.arm.length_m = length_m;
                robot.arm.center_of_mass_m = 0.4;
                robot.arm.joint_x_m = 0.03;
                robot.arm.joint_z_m = -0.04;
                robot.arm.drag = {0.02, 0.05};
                robot.arm.wash.emplace();
                double largest[4] = {}, difference[4] = {};
                for (int degrees = -180; degrees < 180; degrees += 3) {
                    const double q[4] = {0.3, 2, 0.2, degrees * M_PI / 180};
                    const double u[4] = {0.5, -0.3, 0.2, 0.6};
                    const Load load = wash_of(robot, q, u, {24, 18});
                    const Load fine = fine_wash_of(robot, q, u, {24, 18});
                    for (int i = 0; i < 4; ++i) {
                        largest[i] = std::max(largest[i], std::abs(fine.force[i]));
                        difference[i] = std::max(difference[i], std::abs(fine.force[i] - load.force[i]));
                    }
                }
                for (int i = 0; i < 4; ++i) {
                    CAPTURE(i);
                    CHECK(difference[i] < 0.03 * largest[i]);
                }
                CHECK(largest[1] > 0.5);
            }
        }
    }
}

TEST_CASE("Rotors that mirror each other share a slipstream, and those that never meet the arm have none") {
    Robot robot = washed_robot();
    const Slipstreams four = slipstreams_of(robot.arm, robot.rotors);
    REQUIRE(four.count == 3);  // in front, behind, and both beside
    CHECK(four.of_rotor[0] == 0);
    CHECK(four.of_rotor[1] == 1);
    CHECK(four.of_rotor[2] == 2);
    CHECK(four.of_rotor[3] == 2);
    CHECK(four.lateral_m[2] == 0.45);

    // A pair with different thrusts moves the air like one with the same momentum.
    robot.rotors.positions_m = {{0.3, 0.1, 0.06}, {0.3, -0.1, 0.06}, {-0.3, 0.1, 0.06}, {-0.3, -0.1, 0.06}};
    const double q[4] = {0, 2, 0, 0.5};
    const Load uneven = wash_of(robot, q, {0, 0, 0, 0}, {16, 8, 12, 12});
    CHECK(uneven.force[3] == Approx(wash_of(robot, q, {0, 0, 0, 0}, {12, 12, 12, 12}).force[3]));
    CHECK(uneven.force[3] > 0.1);

    robot.rotors.positions_m = {{0.3, 0, 0.06}, {-0.3, 0.9, 0.06}, {-0.3, -0.9, 0.06}};
    const Slipstreams one = slipstreams_of(robot.arm, robot.rotors);
    CHECK(one.count == 1);
    CHECK(one.of_rotor[2] == 1);

    robot.arm.wash->scale = 0;
    CHECK(slipstreams_of(robot.arm, robot.rotors).count == 0);
    robot.arm.wash.reset();
    CHECK(slipstreams_of(robot.arm, robot.rotors).count == 0);
}
