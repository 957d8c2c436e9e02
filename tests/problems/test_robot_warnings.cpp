#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

Robot shipped() {
    return read_robot(DOWNWASH_PROBLEMS "/robots/ars_lrm.yaml");
}

/// The warnings of a key, on one line each.
std::vector<std::string> warnings_of(const Robot& robot, const std::string& key) {
    std::vector<std::string> found;
    for (const KeyError& warning : robot_warnings(robot)) {
        if (warning.key == key) {
            found.push_back(warning.message);
        }
    }
    return found;
}

}  // namespace

TEST_CASE("a shipped robot is warned of nothing") {
    CHECK(robot_warnings(shipped()).empty());
}

TEST_CASE("rotors one above the other are warned of: the lower one counts in full") {
    Robot robot = shipped();
    const auto upper = robot.rotors.positions_m;
    for (auto hub : upper) {
        hub[2] -= 0.1;
        robot.rotors.positions_m.push_back(hub);
    }
    const auto warnings = warnings_of(robot, "rotors.positions_m");
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("puts the rotors 1 and 5 one above the other, one of 4 such pairs: ") &&
                                Contains("1.2 to 1.4 times the power"));
    // Also where the discs overlap in part only, as those of a staggered tandem.
    Robot tandem = shipped();
    tandem.rotors.positions_m[0] = {0.32, 0.19, 0.2};
    tandem.rotors.positions_m[1] = {0.32, -0.19, 0.06};
    CHECK_THAT(warnings_of(tandem, "rotors.positions_m").at(0), Contains("the rotors 1 and 2 one above the other: "));
    tandem.rotors.positions_m[0][1] = 0.1905;
    tandem.rotors.positions_m[1][1] = -0.1905;
    CHECK(warnings_of(tandem, "rotors.positions_m").empty());
    // In one plane they overlap, and are not coaxial.
    robot = shipped();
    robot.rotors.positions_m[0][1] = 0.1;
    robot.rotors.positions_m[1][1] = -0.1;
    CHECK_THAT(warnings_of(robot, "rotors.positions_m").at(0), Contains("their discs overlap"));
}

TEST_CASE("thrusts in gram-force are warned of") {
    Robot robot = shipped();
    robot.rotors.max_thrust_n = 2855;  // gram-force of 28 N
    const auto warnings = warnings_of(robot, "rotors.max_thrust_n");
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0] ==
          "is 2855, and all rotors lift 235 times the weight: expected newtons of one rotor; if these are gram-force, "
          "as in data sheets, it is 28 N");
    // Four rotors of 240 N lift 4.95 kg 19.8 times, racing vehicles up to 15 times.
    robot.rotors.max_thrust_n = 240;
    CHECK(warnings_of(robot, "rotors.max_thrust_n").empty());
    robot.rotors.max_thrust_n = 250;
    CHECK(warnings_of(robot, "rotors.max_thrust_n").size() == 1);
}

TEST_CASE("a robot that problems with uncertainty will not take is warned of without one") {
    Robot robot = shipped();
    robot.uncertainty.reset();
    robot.controller.rate_hz = 1000;
    robot.controller.delay_s = 0.05;
    CHECK(warnings_of(robot, "controller.delay_s") ==
          std::vector<std::string>{
              "is too uncertain by default for problems with an `uncertainty:`: delay_s reaches from 0.025 to 0.075 s: "
              "expected 0 to 64 control ticks, 0.064 s; a controller.rate_hz of 853 or less would do, or a narrower "
              "{range: "
              "[low, high]} of delays"});
    robot.controller.rate_hz = 850;
    CHECK(warnings_of(robot, "controller.delay_s").empty());
}

TEST_CASE("limits of the arm in radians are warned of") {
    Robot robot = shipped();
    robot.arm.is_limited = true;
    const auto limit = [&robot](double low_deg, double high_deg) {
        robot.arm.lower_limit_rad = low_deg / degrees_per_radian;
        robot.arm.upper_limit_rad = high_deg / degrees_per_radian;
        return warnings_of(robot, "arm.limits_deg");
    };
    CHECK(limit(-0.2, 2.9) == std::vector<std::string>{"lets the arm turn by 3.1 degrees only: expected degrees; if "
                                                       "these are radians, it is [-11.46, 166.2]"});
    CHECK(limit(-11.5, 166).empty());
    CHECK(limit(-5, 5).empty());
    CHECK(limit(80, 82.5).empty());
}

TEST_CASE("places and inertias that do not fit the robot's size are warned of") {
    Robot robot = shipped();
    for (Vector3& hub_m : robot.rotors.positions_m) {
        hub_m = {10 * hub_m[0], 10 * hub_m[1], hub_m[2]};
    }
    CHECK_THAT(warnings_of(robot, "rotors.positions_m").at(0),
               StartsWith("puts rotor 1 4.525 m from the centre of mass, and multirotor.body reaches 0.7354 m: "));
    robot = shipped();
    robot.multirotor.pitch_inertia_kg_m2 = 0.002;
    CHECK_THAT(warnings_of(robot, "multirotor.pitch_inertia_kg_m2").at(0), Contains("0.02108 m from the axis"));
    robot = shipped();
    robot.arm.inertia_kg_m2 = 0.0001;
    CHECK_THAT(warnings_of(robot, "arm.inertia_kg_m2").at(0), Contains("reaches 1.2 m"));
}

TEST_CASE("masses in grams are named where the rotors cannot lift them") {
    Robot robot = shipped();
    robot.multirotor.mass_kg = 4500;
    CHECK_THAT(robot_errors(robot).at(0).message, EndsWith("; masses are in kilograms, not in grams"));
    robot.multirotor.mass_kg = 20;
    CHECK_THAT(robot_errors(robot).at(0).message, !Contains("grams"));
}

TEST_CASE("angles in radians and energies that no hover can do with are warned of") {
    Problem problem = read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    const auto warned = [&problem](const std::string& key) {
        for (const KeyError& warning : problem_warnings(problem)) {
            if (warning.key == key) {
                return warning.message;
            }
        }
        return std::string();
    };
    const auto with_arm_deg = [&](double degrees) {
        problem.start.at.coordinate[plane::arm] = degrees / degrees_per_radian;
        return warned("start.arm_deg");
    };
    CHECK(with_arm_deg(1.57) == "is 1.57 degrees: if these are radians, it is 89.95");
    CHECK_FALSE(with_arm_deg(-3.1416).empty());
    for (const double fine_deg : {0.0, 90.0, 1.5, 5.5, 45.0, 3.0}) {
        CHECK(with_arm_deg(fine_deg).empty());
    }
    problem.plane = PlaneOfMotion(problem.plane.origin_m(), 1.5708 / degrees_per_radian);
    CHECK(warned("environment.plane.heading_deg") == "is 1.571 degrees: if these are radians, it is 90");

    problem.targets = {problem.goal};
    problem.energy_budget_j = 15;
    CHECK_THAT(warned("goal.energy_budget_j"), StartsWith("is 15: expected joules (1 kJ is 1000"));
    problem.energy_budget_j = 15000;
    CHECK(warned("goal.energy_budget_j").empty());
}
