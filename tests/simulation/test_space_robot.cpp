#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/space_robot_facts.hpp"
#include "downwash/simulation/space_statics.hpp"

using namespace downwash;

namespace {

constexpr double g = standard_gravity_m_s2;

Matrix3 diagonal(double xx, double yy, double zz) {
    return {{{xx, 0, 0}, {0, yy, 0}, {0, 0, zz}}};
}

/// A quadrotor of 2 kg with an arm of two links below it: the first turns about y, the second about the first's z.
SpaceRobot two_link_robot() {
    SpaceRobot robot;
    robot.name = "two_links";
    robot.plant.multirotor = {2, diagonal(0.02, 0.03, 0.04)};
    robot.plant.power_coefficient_w_n1p5 = 5;
    for (const auto& [x, y, spin] : {std::tuple{0.2, 0.2, 1}, {-0.2, 0.2, -1}, {-0.2, -0.2, 1}, {0.2, -0.2, -1}}) {
        robot.plant.rotors.push_back({{x, y, 0}, {0, 0, 1}, spin, 0.02});
    }
    robot.min_thrust_n.assign(4, 0);
    robot.max_thrust_n.assign(4, 12);
    robot.rotor_radius_m = 0.12;
    robot.body = {{Box{{0.6, 0.6, 0.1}}, {}}};
    robot.plant.links = {{{0.2, diagonal(1e-4, 1e-3, 1e-3)}, {0, 0, -0.05}, {0, 1, 0}, {0.1, 0, 0}},
                         {{0.1, diagonal(1e-4, 1e-3, 1e-3)}, {0.2, 0, 0}, {0, 0, 1}, {0.15, 0, 0}}};
    robot.links.resize(2);
    for (SpaceLinkLimits& link : robot.links) {
        link.is_limited = true;
        link.lower_limit_rad = -2;
        link.upper_limit_rad = 2;
        link.max_torque_nm = 2;
    }
    robot.plant.end_effector_m = {0.3, 0, 0};
    auto& law = std::get<SpaceInversion>(robot.controller.law);
    law.horizontal.kp_1_s2 = 2;
    return robot;
}

}  // namespace

TEST_CASE("A sound robot in space has no errors") {
    CHECK(space_robot_errors(two_link_robot()).empty());
}

TEST_CASE("Joints turn what they carry: places of an arm in space by hand") {
    const SpaceRobot robot = two_link_robot();
    const double quarter = std::numbers::pi / 2;
    const ArmPose down = arm_pose(robot, {quarter, 0});  // about y: forward becomes down
    CHECK(down.end_effector_m[0] == Approx(0).margin(1e-12));
    CHECK(down.end_effector_m[2] == Approx(-0.05 - 0.2 - 0.3));
    CHECK(down.axis[1][0] == Approx(1));  // the first link's z points forward now
    const ArmPose aside = arm_pose(robot, {0, quarter});
    CHECK(aside.end_effector_m[0] == Approx(0.2));
    CHECK(aside.end_effector_m[1] == Approx(0.3));
    CHECK(aside.direction[1] == Approx(1));
}

TEST_CASE("The first joint carries both links, most of all when they are level and stretched") {
    const SpaceRobot robot = two_link_robot();
    const double level_nm = g * (0.2 * 0.1 + 0.1 * (0.2 + 0.15));
    CHECK(holding_torque_nm(robot, arm_pose(robot, {0, 0}), 0) == Approx(-level_nm));  // about +y: it holds upwards
    CHECK(holding_torque_nm(robot, arm_pose(robot, {0, 0}), 1) == Approx(0).margin(1e-12));
    const WorstPose worst = worst_pose(
        robot, [&](const std::vector<double>& q) { return -holding_torque_nm(robot, arm_pose(robot, q), 0); });
    CHECK(worst.value == Approx(level_nm));
    // The second link turns about an axis that is level when the first one hangs.
    const WorstPose second = worst_pose(
        robot, [&](const std::vector<double>& q) { return holding_torque_nm(robot, arm_pose(robot, q), 1); });
    CHECK(second.value == Approx(g * 0.1 * 0.15).epsilon(1e-6));
}

TEST_CASE("No pose of a fine grid asks more of a joint than the worst that is found") {
    SpaceRobot robot = two_link_robot();
    robot.links[0].lower_limit_rad = 0.4;  // a level first link is out of reach
    robot.links[1].upper_limit_rad = -0.3;
    const auto torque_nm = [&](const std::vector<double>& q) {
        return -holding_torque_nm(robot, arm_pose(robot, q), 0);
    };
    const double found_nm = worst_pose(robot, torque_nm).value;
    double most_nm = 0;
    for (double a = 0.4; a <= 2; a += 0.01) {
        for (double b = -2; b <= -0.3; b += 0.01) {
            most_nm = std::max(most_nm, torque_nm({a, b}));
        }
    }
    CHECK(found_nm >= most_nm);
    CHECK(found_nm < 1.001 * most_nm);
}

TEST_CASE("Rotors share a weight so that force and moments balance") {
    SpaceRobot robot = two_link_robot();
    robot.plant.rotors[1].axis = {0.1, -0.05, 1};
    robot.plant.rotors[2].drag_torque_m = 0.03;
    const Vector3 at_m{0.03, -0.02, -0.1};
    const std::vector<double> shares = thrust_shares(robot.plant, at_m);
    REQUIRE(shares.size() == 4);
    double lift = 0;
    Vector3 torque{};
    for (std::size_t k = 0; k < 4; ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        const Vector3 axis = (1 / std::sqrt(dot(rotor.axis, rotor.axis))) * rotor.axis;
        lift += shares[k] * axis[2];
        torque = torque + shares[k] * (cross(rotor.position_m, axis) + (-rotor.spin * rotor.drag_torque_m) * axis);
    }
    CHECK(lift == Approx(1));
    const Vector3 wanted = cross(at_m, {0, 0, 1});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(torque[axis] == Approx(wanted[axis]).margin(1e-12));
    }
}

TEST_CASE("Mass, thrust, reach and hover share of a robot in space follow by hand") {
    const SpaceRobotFacts facts = space_robot_facts(two_link_robot());
    CHECK(facts.mass_kg == Approx(2.3));
    CHECK(facts.joints == 2);
    CHECK(facts.thrust_to_weight == Approx(48 / (2.3 * g)));
    CHECK(facts.reach_m == Approx(0.05 + 0.2 + 0.3));  // stretched downwards, away from the centre of mass
    // Level and stretched forwards: the moment about y is carried by levers of 0.2 m, front and rear alike.
    const double front_n = 2.3 * g / 4 + g * (0.2 * 0.1 + 0.1 * 0.35) / (4 * 0.2);
    CHECK(facts.hover_share >= front_n / 12 * (1 - 1e-9));
    CHECK(facts.hover_share < 1.1 * front_n / 12);
}

TEST_CASE("Rotors that cannot turn a vehicle have a lower rank") {
    SpaceRobot robot = two_link_robot();
    CHECK(allocation_rank(robot.plant, true) == 4);
    for (SpaceRotor& rotor : robot.plant.rotors) {
        rotor.spin = 1;
    }
    CHECK(allocation_rank(robot.plant, false) == 3);
    CHECK(allocation_rank(robot.plant, true) == 3);
    // Alternately tilted sideways, rotors of one spin turn the vehicle in yaw.
    for (std::size_t k = 0; k < 4; ++k) {
        const Vector3& at_m = robot.plant.rotors[k].position_m;
        const double sign = k % 2 == 0 ? 0.1 : -0.1;
        robot.plant.rotors[k].axis = {-sign * at_m[1], sign * at_m[0], 1};
    }
    CHECK(allocation_rank(robot.plant, true) == 4);
    for (SpaceRotor& rotor : robot.plant.rotors) {
        rotor.axis = {0, 0, 1};
        rotor.position_m[1] = rotor.position_m[0];
    }
    CHECK(allocation_rank(robot.plant, false) == 2);
}

TEST_CASE("A robot in space that was made by hand with lists of wrong lengths is told so") {
    SpaceRobot robot = two_link_robot();
    robot.min_thrust_n.pop_back();
    robot.links.pop_back();
    std::vector<std::string> keys;
    for (const KeyError& error : space_robot_errors(robot)) {
        keys.push_back(error.key);
    }
    CHECK(keys == std::vector<std::string>{"rotors.min_thrust_n", "arm.links"});
}

TEST_CASE("A pose in which a rotor would need more than it gives is a warning") {
    SpaceRobot robot = two_link_robot();
    CHECK(space_robot_warnings(robot).empty());
    robot.max_thrust_n = {6, 12, 12, 6};
    const auto warnings = space_robot_warnings(robot);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].key == "rotors.max_thrust_n");
}
