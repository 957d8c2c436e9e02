#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "edits.hpp"
#include "space_files.hpp"

// What reading a problem in space tells of goals that cannot be met, with the place in the file.

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// Warnings of keys that begin so, as "line:column: message".
std::vector<std::string> warnings_of(const std::string& problem, const std::string& robot,
                                     const std::string& keys = "goal") {
    const TestFolder folder;
    folder.write("problem.yaml", problem);
    folder.write("robot.yaml", robot);
    std::vector<std::string> warnings;
    static_cast<void>(read_space_problem(folder / "problem.yaml", {}, [&](const LocatedError& warning) {
        if (warning.message.starts_with(keys)) {
            warnings.push_back(std::to_string(warning.line) + ":" + std::to_string(warning.column) + ": " +
                               warning.message);
        }
    }));
    return warnings;
}

constexpr const char* goal =
    "  end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}\n  hold_s: 5";
constexpr const char* pole = "    - {name: pole,";

std::string with_obstacle(const std::string& line) {
    return edited(good_space_problem, pole, "    - " + line + "\n" + pole);
}

}  // namespace

TEST_CASE("a goal in space that can be met has no warning") {
    CHECK(warnings_of(std::string(good_space_problem), std::string(good_space_robot)).empty());
}

TEST_CASE("a goal in space that nothing meets freely is a warning with what is in the way") {
    const std::vector<std::string> blocked =
        warnings_of(with_obstacle("{name: block, box: {size_m: [2, 2, 0.1], center_m: [3, -2, 2.5]}}"),
                    std::string(good_space_robot));
    REQUIRE(blocked.size() == 1);
    CHECK_THAT(blocked[0], StartsWith("12:3: goal.end_effector is met by no configuration of ") &&
                               Contains(" are nearer than 0.05 m to an obstacle ('block')") &&
                               Contains("; the nearest goal found is 0.05 m away, with position_m ["));
}

TEST_CASE("a goal that a hover misses in many worlds is a warning, a wider one and one without a certificate are not") {
    const std::string with_hexarotor =
        edited(edited(good_space_problem, "robot: robot.yaml",
                      "robot: " + std::string(DOWNWASH_PROBLEMS) + "/robots/hexa370_arm3.yaml"),
               "joints_deg: [20, -10]", "joints_deg: [0, 0, 0]");
    const auto of_tolerance = [&](const std::string& tolerance_m, const std::string& more) {
        return warnings_of(edited(with_hexarotor, "tolerance_m: 0.1, direction: [0, 0, 1]",
                                  "tolerance_m: " + tolerance_m + ", direction: [0, 0, -1]") +
                               more,
                           std::string(good_space_robot));
    };
    const std::vector<std::string> missed = of_tolerance("0.02", "uncertainty: {}\n");
    REQUIRE(missed.size() == 1);
    CHECK_THAT(missed[0], StartsWith("11:3: goal.end_effector is missed in ") &&
                              Contains(" of 512 worlds by a vehicle that hovers in its middle") &&
                              Contains("widen its tolerances"));
    CHECK(of_tolerance("0.1", "uncertainty: {}\n").empty());
    CHECK(of_tolerance("0.02", "uncertainty: {}\nplanner: {certify: false}\n").empty());
    CHECK(of_tolerance("0.02", "").empty());
}

TEST_CASE("one alternative that can be met is enough") {
    const std::string near = "{end_effector: {position_m: [3, -2, 2.5]}}",
                      far = "{end_effector: {position_m: [0, 0, 2]}}";
    const std::string block = with_obstacle("{name: block, box: {size_m: [2, 2, 2], center_m: [3, -2, 2.5]}}");
    CHECK(warnings_of(edited(block, goal, "  any_of: [" + near + ", " + far + "]"), std::string(good_space_robot))
              .empty());
    const std::string plate = with_obstacle("{name: block, box: {size_m: [2, 2, 0.1], center_m: [3, -2, 2.5]}}");
    CHECK(warnings_of(edited(plate, goal, "  any_of: [" + near + ", " + near + "]"), std::string(good_space_robot))
              .size() == 2);
}

TEST_CASE("a goal in space behind a wall is a warning with the wall") {
    // A ball of 0.2 m fits into the body.
    const std::string robot = edited(good_space_robot, "size_m: [0.6, 0.6, 0.1]", "size_m: [0.6, 0.6, 0.4]");
    const std::vector<std::string> behind =
        warnings_of(with_obstacle("{name: wall, box: {size_m: [0.01, 20, 20], center_m: [0, 0, 0]}}"), robot);
    REQUIRE(behind.size() == 1);
    CHECK_THAT(behind[0], StartsWith("12:3: goal.end_effector is cut off from the start: not even a ball of 0.2 m") &&
                              Contains("'wall'"));
    // A gap of a metre below the top of the bounds.
    CHECK(warnings_of(with_obstacle("{name: wall, box: {size_m: [0.01, 20, 4], center_m: [0, 0, 2]}}"), robot).empty());
}

TEST_CASE("a force that the robot cannot press with is a warning with what it lacks") {
    const auto pressed = [](const std::string& force_n) {
        return edited(edited(good_space_problem, goal, "  contact: {obstacle: wall, force_n: " + force_n + "}"), pole,
                      "    - {name: wall, box: {size_m: [1, 6, 6], center_m: [5, 0, 2]}}\n" + std::string(pole));
    };
    const std::string robot(good_space_robot);
    CHECK(warnings_of(pressed("2"), robot).empty());
    const std::vector<std::string> warnings = warnings_of(pressed("100"), robot);
    REQUIRE(warnings.size() == 1);
    // The weight of 2.3 kg and 100 N across it: 102.5 N of four times 12 N.
    CHECK_THAT(warnings[0], StartsWith("12:38: goal.contact.force_n takes 103 N of thrust, and its rotors give 48 N at "
                                       "most, at each of 20 places that were tried; press less"));
}

TEST_CASE("a direction that the joints do not allow is an error with the range that they do") {
    const std::string stiff = edited(good_space_robot, "limits_deg: [-120, 120]", "limits_deg: [-30, 30]");
    CHECK(space_errors(TestFolder(), good_space_problem, stiff) ==
          "problem.yaml:11:73: goal.end_effector.direction is 90 degrees above the level, give or take 5: with its "
          "joints within their limits the end effector of the level robot points -30 to 30 degrees above it; the "
          "nearest direction is [0.866, 0, 0.5], or give the arm other joints or limits");
    const std::string pose =
        edited(good_space_problem, "end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
               "pose: {position_m: [3, -2, 2.5], rpy_deg: [180, 0, 0]}");
    CHECK_THAT(space_errors(TestFolder(), pose, good_space_robot),
               StartsWith("problem.yaml:11:45: goal.pose.rpy_deg is an attitude that the level robot misses by 60 "
                          "degrees at any yaw, with its joints within their limits; the nearest one is ["));
}

TEST_CASE("what a value in space counts for nothing beside, or what is likely in another unit, is a warning") {
    const std::string robot(good_space_robot);
    const auto start = [](const std::string& with) {
        return edited(good_space_problem, "yaw_deg: 30, joints_deg: [20, -10]", with);
    };
    CHECK(warnings_of(start("yaw_deg: 90, attitude: [2, 0, 0, 2], joints_deg: [20, -10]"), robot, "start").empty());
    CHECK(warnings_of(start("yaw_deg: 30, attitude: [2, 0, 0, 2], joints_deg: [20, -10]"), robot, "start") ==
          std::vector<std::string>{"9:43: start.yaw_deg counts for nothing beside start.attitude, whose yaw is 90 "
                                   "degrees; leave one of them out"});
    CHECK(warnings_of(start("yaw_deg: 1.571, joints_deg: [20, -0.785]"), robot, "start") ==
          std::vector<std::string>{"9:43: start.yaw_deg is 1.571 degrees: if these are radians, it is 90.01",
                                   "9:62: start.joints_deg is -0.785 degrees: if these are radians, it is -44.98"});

    const auto targets = [](const std::string& second, const std::string& more = "") {
        return edited(good_space_problem, goal,
                      "  in_any_order:\n    - end_effector: {position_m: [3, -2, 2.5]}\n    - " + second + "\n" + more);
    };
    const std::string other = "end_effector: {position_m: [2, -2, 2.5]}";
    CHECK(warnings_of(targets(other, "  energy_budget_j: 20000"), robot).empty());
    CHECK(
        warnings_of(targets("end_effector: {position_m: [3, -2, 2.5]}"), robot) ==
        std::vector<std::string>{"13:7: goal.in_any_order[1] is the same as goal.in_any_order[0], so the vehicle goes "
                                 "there twice; leave one of them out"});
    CHECK(
        warnings_of(targets("end_effector: {position_m: [2, -2, 2.5], direction_tolerance_deg: 3}"), robot) ==
        std::vector<std::string>{"13:73: goal.in_any_order[1].end_effector.direction_tolerance_deg counts for nothing "
                                 "without goal.in_any_order[1].end_effector.direction; give one"});
    CHECK(warnings_of(targets("camera: {target_m: [3, -2, 2], distance_m: [1, 2], view_cone_deg: 20}"), robot) ==
          std::vector<std::string>{"13:73: goal.in_any_order[1].camera.view_cone_deg counts for nothing without "
                                   "goal.in_any_order[1].camera.direction; give one"});
    // Four rotors that lift a quarter of 2.3 kg each: 5 W/N^1.5 * 4 * 5.64^1.5 N = 268 W.
    CHECK(warnings_of(targets(other, "  energy_budget_j: 20"), robot) ==
          std::vector<std::string>{"14:20: goal.energy_budget_j is 20: expected joules (1 kJ is 1000, 1 Wh is 3600); a "
                                   "hover in free air takes 267.8 W, so the hovers at one target take about 1339 J by "
                                   "themselves"});

    CHECK(warnings_of(start("joints_deg: [20, 0]"), edited(robot, "limits_deg: [-90, 90]", "limits_deg: [-1.6, 1.6]"),
                      "arm") ==
          std::vector<std::string>{"20:95: arm.links[1].limits_deg lets the arm turn by 3.2 degrees only: expected "
                                   "degrees; if these are radians, it is [-91.67, 91.67]"});
}
