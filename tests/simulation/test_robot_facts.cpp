#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "../support/test_robot.hpp"
#include "downwash/simulation/robot_facts.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("The rotors under a level arm carry its moment: mass, thrust and hover share of a robot") {
    const Robot robot = test_robot();
    const RobotFacts facts = robot_facts(robot);
    CHECK(facts.mass_kg == Approx(4.95));
    CHECK(facts.thrust_to_weight == Approx(4 * 28 / (4.95 * standard_gravity_m_s2)));
    // Two rotors 0.32 m in front and two as far behind; the arm's centre of mass is 0.72 m in front.
    const double front_n = 4.95 * standard_gravity_m_s2 / 4 + 0.45 * standard_gravity_m_s2 * 0.72 / (4 * 0.32);
    CHECK(facts.hover_share == Approx(front_n / 28));
    CHECK(facts.hover_rotor == 0);
    CHECK(facts.hover_arm_rad == 0);
}

TEST_CASE("An arm that cannot be level asks most at the limit that is nearest to it") {
    Robot robot = test_robot();
    limit_arm(robot, std::numbers::pi / 3, 0.9 * std::numbers::pi);
    const RobotFacts facts = robot_facts(robot);
    const double lever_m = 0.72 * std::cos(0.9 * std::numbers::pi);
    const double rear_n =
        4.95 * standard_gravity_m_s2 / 4 - 0.45 * standard_gravity_m_s2 * lever_m / (4 * 0.32);  // the lever is behind
    CHECK(facts.hover_share == Approx(rear_n / 28));
    CHECK(facts.hover_rotor == 2);
    CHECK(facts.hover_arm_rad == Approx(0.9 * std::numbers::pi));
}

TEST_CASE("A vehicle that lifts its weight but not with a level arm needs more than a rotor has, and has no margins") {
    Robot robot = test_robot();
    robot.rotors.max_thrust_n = 13.5;
    REQUIRE(robot_errors(robot).empty());
    const RobotFacts facts = robot_facts(robot);
    CHECK(facts.thrust_to_weight > 1);
    CHECK(facts.hover_share > 1);
    CHECK_FALSE(facts.margins);
}

TEST_CASE("The reach of an arm counts from the centre of mass, as far as its limits allow") {
    Robot robot = test_robot();
    CHECK(robot_facts(robot).reach_m == Approx(1.2));
    robot.arm.joint_x_m = 0.3;
    robot.arm.joint_z_m = -0.1;
    CHECK(robot_facts(robot).reach_m == Approx(std::hypot(0.3, 0.1) + 1.2));
    limit_arm(robot, quarter_turn, 2 * quarter_turn);  // down to backward: never away from the joint
    CHECK(robot_facts(robot).reach_m == Approx(std::hypot(0.3, 0.1 + 1.2)));
    limit_arm(robot, 3.5 * quarter_turn, 4.5 * quarter_turn);  // around forward, a turn later
    CHECK(robot_facts(robot).reach_m == Approx(std::hypot(0.3, 0.1) + 1.2));
}

TEST_CASE("The least margins are the least of all loops with the arm up, level and down, each with its place") {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    const auto least = robot_facts(robot).margins;
    REQUIRE(least);
    double gain_db = HUGE_VAL, phase_rad = HUGE_VAL;
    for (const double arm_rad : {-quarter_turn, 0.0, quarter_turn}) {
        for (const LoopMargins& loop : loop_margins(robot, arm_rad)) {
            gain_db = std::min(gain_db, loop.gain_margin_db);
            phase_rad = std::min(phase_rad, loop.phase_margin_rad);
        }
    }
    CHECK(least->gain_margin_db == gain_db);
    CHECK(least->phase_margin_rad == phase_rad);
    const auto at = [&](double arm_rad, LoopInput input) {
        return loop_margins(robot, arm_rad)[static_cast<std::size_t>(input)];
    };
    CHECK(at(least->gain_arm_rad, least->gain_input).gain_margin_db == gain_db);
    CHECK(at(least->phase_arm_rad, least->phase_input).phase_margin_rad == phase_rad);
}

TEST_CASE("Margins are examined where an arm can be: at its limits if these exclude up, level and down") {
    Robot robot = test_robot();
    CHECK(examined_arm_angles_rad(robot.arm) == std::vector{-quarter_turn, 0.0, quarter_turn});
    limit_arm(robot, -0.1, 90 / 57.29577951308232);
    const std::vector<double> two = examined_arm_angles_rad(robot.arm);
    REQUIRE(two.size() == 2);
    CHECK(two[0] == 0);
    CHECK(two[1] == Approx(quarter_turn));
    CHECK(two[1] <= robot.arm.upper_limit_rad);
    limit_arm(robot, 0.2, 1.2);
    CHECK(examined_arm_angles_rad(robot.arm) == std::vector{0.2, 1.2});
    limit_arm(robot, 0.2, 0.2);
    CHECK(examined_arm_angles_rad(robot.arm) == std::vector{0.2});
    CHECK(robot_facts(robot).margins);
}
