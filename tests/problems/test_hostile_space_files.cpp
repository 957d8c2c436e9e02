#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "../support/test_files.hpp"
#include "edits.hpp"
#include "space_files.hpp"

// What should never stand in a file of a problem in space, and is read all the same: numbers that are none, frames and
// arms that cannot be, goals inside obstacles, far too much of everything.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view at_rest = "yaw_deg: 30, joints_deg: [20, -10]";
constexpr std::string_view goal = "end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}";
constexpr std::string_view goal_lines =
    "  end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}\n  hold_s: 5\n";
constexpr std::string_view hubs = "[[0.2, 0.2, 0], [-0.2, 0.2, 0], [-0.2, -0.2, 0], [0.2, -0.2, 0]]";

const Edit start_edits[] = {
    {at_rest, "attitude: [.nan, 0, 0, 0]",
     "9:45: start.attitude is not finite: expected [w, x, y, z] from -1000 to 1000, or null"},
    {at_rest, "attitude: [1, 0, -.inf, 0]",
     "9:51: start.attitude is not finite: expected [w, x, y, z] from -1000 to 1000, or null"},
    {at_rest, "attitude: [1e308, 0, 0, 1e308]",
     "9:44: start.attitude is 1e+308: expected [w, x, y, z] from -1000 to 1000, or null"},
    {at_rest, "attitude: [1, 0, 0]",
     "9:44: start.attitude has 3 elements: expected [w, x, y, z] from -1000 to 1000, or null"},
    {at_rest, "yaw_deg: 1e300", "9:43: start.yaw_deg is 1e+300: expected a number in deg from -3600 to 3600"},
    {at_rest, "yaw_deg: .nan", "9:43: start.yaw_deg is not finite: expected a number in deg from -3600 to 3600"},
    {at_rest, "joints_deg: [.inf, 0]",
     "9:47: start.joints_deg is not finite: expected a list of numbers in deg from -3600 to 3600"},
    {"x_m: -4, y_m: 1, z_m: 2", "x_m: 4, y_m: 2.9, z_m: 2",
     "9:1: start is in collision with the obstacle 'pole': move the start or the obstacle"},
    {"z_m: [0.5, 5]", "z_m: [5, 0.5]", "5:45: environment.bounds.z_m is [low, high]: expected low below high"},
    {"z_m: [0.5, 5]", "z_m: [2, 2]", "5:45: environment.bounds.z_m is [low, high]: expected low below high"},
    {"z_m: [0.5, 5]", "z_m: [0.5, 1e300]",
     "5:45: environment.bounds.z_m is 1e+300: expected [low, high] in m from -100000 to 100000"},
    {"length_m: 5,", "length_m: 5, axis: [0, 0, 0],",
     "8:65: environment.obstacles[1].cylinder.axis has no direction: expected a vector other than [0, 0, 0]"},
    {"[30, 20, 1]", "[30, .nan, 1]",
     "7:41: environment.obstacles[0].box.size_m is not finite: expected [x, y, z] in m from 1e-06 to 100000"},
    {"[30, 20, 1]", "[30, -20, 1]",
     "7:36: environment.obstacles[0].box.size_m is -20: expected [x, y, z] in m from 1e-06 to 100000"},
};

const Edit goal_edits[] = {
    {"[3, -2, 2.5]", "[3, -2, .nan]",
     "11:38: goal.end_effector.position_m is not finite: expected [x, y, z] in m from -100000 to 100000"},
    {"[3, -2, 2.5]", "[]",
     "11:30: goal.end_effector.position_m has 0 elements: expected [x, y, z] in m from -100000 to 100000"},
    {"direction: [0, 0, 1]", "direction: [0, 0, 1e-320]",
     "11:73: goal.end_effector.direction has no direction: expected a vector other than [0, 0, 0], or null"},
    {"direction: [0, 0, 1]", "direction: [0, 0, 1e300]",
     "11:73: goal.end_effector.direction is 1e+300: expected [x, y, z] from -100000 to 100000, or null"},
    {goal_lines, "  in_any_order:\n    - any_of:\n        - camera: {target_m: [4, 0, 2], distnce_m: [1, 2]}\n",
     "13:41: unknown key 'distnce_m' in goal.in_any_order[0].any_of[0].camera: did you mean 'distance_m'?"},
    {goal_lines, "  in_any_order:\n    - any_of:\n        - kamera: {target_m: [4, 0, 2], distance_m: [1, 2]}\n",
     "13:11: unknown key 'kamera' in goal.in_any_order[0].any_of[0]: did you mean 'camera'?"},
    {goal_lines, "  any_of:\n    - {}\n",
     "12:7: goal.any_of[0] needs exactly one of configuration, end_effector, pose, camera or contact"},
    {goal_lines, "  in_any_order:\n    - any_of: []\n",
     "12:15: goal.in_any_order[0].any_of is empty: expected one element at least"},
    {goal_lines, "  - - configuration: {y_m: 0}\n", "11:5: goal[0] is a list: expected a group of keys"},
    {goal_lines, "  - null\n", "11:5: goal[0] has no value: expected a group of keys"},
    {"goal:\n  end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}\n  hold_s: 5\n",
     "goal: []\n", "10:7: goal is empty: expected one element at least"},
    {goal_lines, "  any_of: &again\n    - any_of: *again\n",
     "12:15: an alias refers to a value that it is part of: write the value out"},
};

const Edit buried_edits[] = {
    {"[3, -2, 2.5]", "[4, 3, 2.5]",
     "11:30: goal.end_effector.position_m is 0.2 m inside the obstacle 'pole': within tolerance_m of it the end "
     "effector touches the obstacle; move the goal out of the obstacle"},
    {goal, "pose: {position_m: [4.05, 3, 1], rpy_deg: [0, 0, 0]}",
     "11:22: goal.pose.position_m is 0.15 m inside the obstacle 'pole': within tolerance_m of it the end effector "
     "touches the obstacle; move the goal out of the obstacle"},
    {goal, "camera: {target_m: [4, 3, 4.9], distance_m: [0.5, 1.5]}",
     "11:22: goal.camera.target_m is 0.1 m inside the obstacle 'pole': no camera sees it there; move the goal out of "
     "the obstacle"},
    {goal, "configuration: {x_m: 4, y_m: 3, z_m: 2.5}",
     "11:3: goal.configuration is 0.2 m inside the obstacle 'pole': within tolerance_m of it the vehicle touches the "
     "obstacle; move the goal out of the obstacle"},
    {goal_lines, "  in_any_order:\n    - configuration: {y_m: 0}\n  return_to: {x_m: 4, y_m: 3, z_m: 2.5}\n",
     "13:3: goal.return_to is 0.2 m inside the obstacle 'pole': within tolerance_m of it the vehicle touches the "
     "obstacle; move the goal out of the obstacle"},
    {goal_lines, "  - configuration: {y_m: 0}\n  - any_of:\n      - end_effector: {position_m: [4, 3, 2.5]}\n",
     "13:36: goal[1].any_of[0].end_effector.position_m is 0.2 m inside the obstacle 'pole': within tolerance_m of it "
     "the end effector touches the obstacle; move the goal out of the obstacle"},
};

const Edit robot_edits[] = {
    {"mass_kg: 2\n", "mass_kg: -2\n", "4:12: multirotor.mass_kg is -2: expected a number in kg from 0.0001 to 10000"},
    {"mass_kg: 0.2", "mass_kg: .nan",
     "17:58: arm.links[0].mass_kg is not finite: expected a number in kg from 0.0001 to 10000"},
    {"[0.02, 0.03, 0.04]", "[0.02, 0.03, .nan]",
     "5:31: multirotor.inertia_kg_m2 is not finite: expected [xx, yy, zz] or the rows of a 3 x 3 matrix in kg m2 from "
     "1e-10 to 100000"},
    {"[0.0001, 0.001, 0.001]", "[0.0001, 0.001, 0.0012]",
     "18:23: arm.links[0].inertia_kg_m2 has the principal moments 0.0001, 0.001 and 0.0012 kg m2, which no body has: "
     "expected the largest to be at most the sum of the others, 0.0011"},
    {hubs, "[[0.1, 0.1, 0], [0.1, 0.1, 0], [0.1, 0.1, 0], [0.1, 0.1, 0]]",
     "10:16: rotors.positions_m gives the rotors no lever in roll or in pitch: expected hubs that do not lie on one "
     "line"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: 0.02\n  axes: [[0, 0, -1], [0, 0, -1], [0, 0, -1], [0, 0, -1]]",
     "13:9: rotors.axes of rotor 1 points down: expected thrust upwards, with x forward, y left and z up; where z is "
     "down, y and z have the other sign"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: 0.02\n  axes: [[0, 0, .nan], [0, 0, 1], [0, 0, 1], [0, 0, 1]]",
     "13:17: rotors.axes is not finite: expected a list of [x, y, z] from -100000 to 100000"},
    {"axis: [0, 1, 0]", "axis: [0, .nan, 0]",
     "17:42: arm.links[0].axis is not finite: expected [x, y, z] from -100000 to 100000"},
    {"{joint_m: [0.2, 0, 0],", "{parent: 1, joint_m: [0.2, 0, 0],",
     "19:8: unknown key 'parent' in arm.links[1]: expected joint_m, axis, mass_kg, center_of_mass_m, inertia_kg_m2, "
     "limits_deg, max_torque_nm, friction, drag or body"},
    {"  end_effector_m", "    - &link\n      body: [*link]\n  end_effector_m",
     "23:14: an alias refers to a value that it is part of: write the value out"},
};

std::string times(std::size_t count, std::string_view text) {
    std::string all;
    all.reserve(count * text.size());
    for (std::size_t i = 0; i < count; ++i) {
        all += text;
    }
    return all;
}

/// What reading the sound problem says with other lines for its goal.
std::string errors_with_goal(const std::string& lines) {
    return space_errors(TestFolder(), edited(good_space_problem, goal_lines, lines), good_space_robot);
}

}  // namespace

TEST_CASE("numbers that are none, attitudes without a turn and reversed bounds in space are errors at their keys") {
    check(start_edits, "problem.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), edited(good_space_problem, from, to), good_space_robot);
    });
}

TEST_CASE("goals in space that are none, empty or part of themselves are errors at their keys") {
    check(goal_edits, "problem.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), edited(good_space_problem, from, to), good_space_robot);
    });
}

TEST_CASE("a goal deep inside an obstacle is an error that names the obstacle") {
    check(buried_edits, "problem.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), edited(good_space_problem, from, to), good_space_robot);
    });
}

TEST_CASE("a goal inside an obstacle is no error as long as the robot may be beside it") {
    CHECK(errors_with_goal("  end_effector: {position_m: [4, 3, 2.5], tolerance_m: 0.25}\n") == "sound");
    CHECK(errors_with_goal("  configuration: {x_m: 4, y_m: 3}\n") == "sound");
    CHECK(errors_with_goal("  any_of: [{end_effector: {position_m: [4, 3, 2.5]}}, {configuration: {y_m: 0}}]\n") ==
          "sound");
    CHECK(errors_with_goal("  camera: {target_m: [4, 3, 2.5], distance_m: [0.5, 1.5], sees: false}\n") == "sound");
    CHECK(errors_with_goal("  camera: {target_m: [3.81, 3, 2.5], distance_m: [0.5, 1.5]}\n") == "sound");
    const std::string bare =
        edited(good_space_robot, ",\n       body: [capsule: {radius_m: 0.02, to_m: [0.3, 0, 0]}]}", "}");
    CHECK(space_errors(TestFolder(), edited(good_space_problem, "[3, -2, 2.5]", "[4, 3, 2.5]"), bare) == "sound");
}

TEST_CASE("how deep a goal is inside an obstacle follows the obstacle's turn") {
    constexpr std::string_view beam =
        "    - {name: beam, box: {size_m: [4, 0.4, 1], center_m: [-2, 0, 3], rpy_deg: [0, 0, 90]}}\nstart:";
    const std::string problem = edited(good_space_problem, "start:", beam);
    CHECK_THAT(space_errors(TestFolder(), edited(problem, "[3, -2, 2.5]", "[-2, 1.85, 3]"), good_space_robot),
               Catch::Contains("is 0.15 m inside the obstacle 'beam'"));
    CHECK(space_errors(TestFolder(), edited(problem, "[3, -2, 2.5]", "[-0.5, 0, 3]"), good_space_robot) == "sound");
}

TEST_CASE("a robot in space with lost numbers, rotors upside down or joints in a loop is an error at its key") {
    check(robot_edits, "robot.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), good_space_problem, edited(good_space_robot, from, to));
    });
}

TEST_CASE("two rotors at one place are a warning, one above the other are not") {
    const auto warnings_with = [](const std::string& second) {
        const TestFolder folder;
        const std::string robot = edited(
            good_space_robot, hubs, "[[0.2, 0.2, 0], " + second + ", [-0.2, 0.2, 0], [-0.2, -0.2, 0], [0.2, -0.2, 0]]");
        folder.write("problem.yaml", good_space_problem);
        folder.write("robot.yaml", edited(robot, "spin: [1, -1, 1, -1]", "spin: [1, 1, -1, 1, -1]"));
        std::string all;
        static_cast<void>(read_space_problem(folder / "problem.yaml", {},
                                             [&](const LocatedError& warning) { all += to_text(warning) + "\n"; }));
        return all;
    };
    CHECK_THAT(warnings_with("[0.2, 0.2, 0]"),
               Catch::EndsWith("robot.yaml:10:16: rotors.positions_m has rotors 1 and 2 at one place: expected "
                               "hubs apart, of coaxial rotors one above the other\n"));
    CHECK(warnings_with("[0.2, 0.2, 0.1]").empty());
}

TEST_CASE("a million of anything in a file in space ends with a few located errors") {
    constexpr std::size_t million = 1'000'000;
    // More than a file may have is not even parsed.
    CHECK(errors_with_goal("  in_any_order:\n" +
                           times(million, "    - camera: {target_m: [3, 0, 2], distance_m: [1, 2]}\n")) ==
          "problem.yaml:1:1: is larger than 32768 KiB: expected a problem or robot file");
    CHECK(errors_with_goal("  in_any_order: [" + times(million, "{configuration: {y_m: 0}},") + "]\n") ==
          "problem.yaml:1:1: has more than 2500000 line breaks, commas, colons and brackets: expected a problem or "
          "robot file");
    // What is parsed is reported up to a hundred times.
    const std::string empty = errors_with_goal("  in_any_order:\n" + times(million, "    - {}\n"));
    CHECK_THAT(empty, Catch::StartsWith("problem.yaml:12:7: goal.in_any_order[0] needs exactly one of "));
    CHECK(std::count(empty.begin(), empty.end(), '\n') < 110);
    CHECK_THAT(space_errors(TestFolder(), edited(good_space_problem, "[20, -10]", "[" + times(million, "0, ") + "0]"),
                            good_space_robot),
               Catch::Contains("9:59: start.joints_deg has 1000001 numbers: expected 2, one for each joint"));
    const std::string obstacles = space_errors(
        TestFolder(), edited(good_space_problem, "start:", times(million, "    - {}\n") + "start:"), good_space_robot);
    CHECK_THAT(obstacles, Catch::StartsWith("problem.yaml:9:7: environment.obstacles[2] needs exactly one of "));
    CHECK(std::count(obstacles.begin(), obstacles.end(), '\n') < 110);
}
