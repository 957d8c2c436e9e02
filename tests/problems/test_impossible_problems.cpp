#include <limits>
#include <vector>

#include "downwash/problems/problem.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

const Edit edits[] = {
    {"x_m: -4", "x_m: -7", "12:14: start.x_m is -7, outside the bounds: expected -6 to 6"},
    {"z_m: 2, arm_deg", "z_m: 5.5, arm_deg", "12:23: start.z_m is 5.5, outside the bounds: expected 0.5 to 5"},
    {"z_m: 2, arm_deg", "z_m: 1, arm_deg",
     "12:1: start is in collision with the obstacle 'ground': move the start or the obstacle"},
    {"z_m: 2, arm_deg", "z_m: 1.25, arm_deg",
     "12:1: start is 0.02 m from the obstacle 'ground', nearer than planner.safety_margin_m, 0.05: move the start or "
     "the "
     "obstacle"},
    {"k1: 6.9}", "k1: 6.9}\n  min_distance_radii: 12",
     "13:1: start is outside the flyable area: the disc of rotor 1 is 2 m from an obstacle; expected at least 2.28 m "
     "(aero.min_distance_radii times the rotor radius)"},
    {"ceiling: {model: sanchez-cuevas, k1: 6.9}", "min_distance_radii: 100",
     "12:1: start is outside the flyable area: the disc of rotor 1 is 2 m from an obstacle; expected at least 19 m "
     "(aero.min_distance_radii times the rotor radius)"},
    {"arm_deg: 90", "arm_deg: 90, pitch_deg: 20, vx_m_s: 1.2, arm_rate_deg_s: -60",
     "12:62: start.vx_m_s makes a start speed of 1.2 m/s: expected at most motion.max_speed_m_s, 1\n12:83: "
     "start.arm_rate_deg_s is faster than motion.max_arm_rate_deg_s: expected at most 45 in size"},
    {"arm_deg: 90", "arm_deg: 90, rotor_thrust_n: [9, 9, 9], controller_memory: [1, 2]",
     "12:55: start.rotor_thrust_n has 3 numbers: expected 4, one for each rotor\n12:85: start.controller_memory has 2 "
     "numbers: expected 7, as many as robot.controller remembers"},
    {"x_m: [-6, 6]", "x_m: [6, -6]", "5:17: environment.bounds.x_m is [6, -6]: expected [low, high], low below high"},
    {"z_m: [0.5, 5]", "z_m: [5, 5]", "5:31: environment.bounds.z_m is [5, 5]: expected [low, high], low below high"},
    {"x_m: [-6, 6], z_m: [0.5, 5]", "x_m: [-6000, 6000], z_m: [0.5, 50]",
     "9:1: aero.grid_m makes a map of 4.81e+08 cells over the bounds: expected at most 1.678e+07; choose a coarser "
     "grid or narrower bounds"},
    {"x_m: 3, z_m: 2.5", "x_m: 9, z_m: 2.5",
     "14:3: goal.end_effector is out of reach: from anywhere within the bounds the arm of 1.2 m misses it by 1.7 m; "
     "widen environment.bounds or move the goal"},
    {"x_m: 3, z_m: 2.5", "x_m: 3, z_m: -2",
     "14:3: goal.end_effector is out of reach: from anywhere within the bounds the arm of 1.2 m misses it by 1.2 m; "
     "widen environment.bounds or move the goal"},
    {"x_m: 3, z_m: 2.5", "x_m: 3, z_m: -0.4",
     "14:3: goal.end_effector is out of reach: in every pose that gets there the robot touches an obstacle or is "
     "nearer to it than planner.safety_margin_m; it is inside the obstacle 'ground'"},
    {"x_m: 3, z_m: 2.5, tolerance_m: 0.1", "x_m: 3, z_m: 6, tolerance_m: 0.1, direction_deg: 90",
     "14:3: goal.end_effector is out of reach: the limits of the arm, the wanted direction and the bounds leave no "
     "pose that gets there"},
    {"end_effector: {x_m: 3, z_m: 2.5", "configuration: {x_m: 7, z_m: 0.1",
     "14:24: goal.configuration.x_m is 7, outside the bounds: expected -6 to 6\n14:32: goal.configuration.z_m is 0.1, "
     "outside the bounds: expected 0.5 to 5"},
    {"end_effector: {x_m: 3, z_m: 2.5", "configuration: {x_m: 3, z_m: 1, arm_deg: 90",
     "14:3: goal.configuration is in collision with an obstacle or nearer to it than planner.safety_margin_m, anywhere "
     "within its tolerances: move the goal or the obstacle"},
    {"seed: 1", "seed: 1, safety_margin_m: 1",
     "12:1: start is 0.77 m from the obstacle 'ground', nearer than planner.safety_margin_m, 1: move the start or the "
     "obstacle"},
};

}  // namespace

TEST_CASE("an impossible problem is an error where it is posed") {
    check(edits, "problem.yaml", [](auto from, auto to) { return errors_after(TestFolder(), from, to); });
    // A narrow but possible goal is accepted.
    const TestFolder folder;
    CHECK(errors_after(folder, "tolerance_m: 0.1",
                       "tolerance_m: 0.1, direction_deg: 90, direction_tolerance_deg: 0.1") == "sound");
    CHECK(errors_after(folder, "end_effector: {x_m: 3, z_m: 2.5", "configuration: {x_m: 3, z_m: 1") == "sound");
    // Without surface effects the flyable area does not matter.
    CHECK(errors_after(folder, "  ceiling: {model: sanchez-cuevas, k1: 6.9}\n", "  min_distance_radii: 12\n") !=
          "sound");
    CHECK(errors_after(folder,
                       "aero:\n  ground: {model: cheeseman-bennett}\n  ceiling: {model: sanchez-cuevas, k1: 6.9}\n",
                       "aero: none\n") == "sound");
}

TEST_CASE("a start that only rounding tells from its margin is not called nearer by numbers that are equal") {
    Problem problem = TestFolder().read();
    const auto error_at = [&](double z_m, double margin_m) {
        problem.start.at[plane::z] = z_m;
        problem.planner.safety_margin_m = margin_m;
        const std::vector<KeyError> errors = problem_errors(problem);
        return errors.empty() ? "none" : errors.front().message;
    };
    const std::string remedy = ": move the start or the obstacle";
    const double touching_m = 1.23;  // by the first case above: 0.02 m higher the clearance is 0.02 m
    CHECK(error_at(touching_m + 1e-12, 0) == "is in collision with the obstacle 'ground'" + remedy);
    CHECK(error_at(touching_m + 0.05 - 1e-9, 0.05) ==
          "is 0.05 m from the obstacle 'ground', up to rounding not beyond planner.safety_margin_m, 0.05" + remedy);
    CHECK(error_at(touching_m + 0.051, 0.05) == "none");
}

TEST_CASE("a problem built in code is judged by the same ranges as a file") {
    Problem problem = TestFolder().read();
    CHECK(problem_errors(problem).empty());
    problem.start.at[plane::x] = std::numeric_limits<double>::quiet_NaN();
    problem.robot.arm.length_m = -1;
    problem.planner.algorithm = "magic";
    const std::vector<KeyError> errors = problem_errors(problem);
    REQUIRE(errors.size() == 3);
    CHECK(errors[0].key == "robot.arm.length_m");
    CHECK(errors[0].message == "is -1: expected a number in m from 0.0001 to 100");
    CHECK(errors[1].key == "start.x_m");
    CHECK(errors[1].message == "is not finite: expected a number in m from -100000 to 100000");
    CHECK(errors[2].key == "planner.algorithm");
    // A robot is judged alone too.
    CHECK(robot_errors(Robot{}).size() >= 10);
}

TEST_CASE("a hover of more control ticks than a plan may have is an error") {
    Problem problem = TestFolder().read();
    problem.robot.controller.rate_hz = 1000;
    problem.goal.hold_s = 360;
    CHECK(problem_errors(problem).empty());
    problem.goal.hold_s = 361;
    const std::vector<KeyError> errors = problem_errors(problem);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].key == "goal.hold_s");
    CHECK(errors[0].message == "is 361: expected at most 360 s, 360000 control ticks");
}
