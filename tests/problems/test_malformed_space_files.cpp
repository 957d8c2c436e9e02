#include <catch2/catch.hpp>
#include <string>

#include "../support/test_files.hpp"
#include "edits.hpp"
#include "space_files.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

const Edit robot_edits[] = {
    {"mass_kg: 2\n", "mass_kg: 0\n", "4:12: multirotor.mass_kg is 0: expected a number in kg from 0.0001 to 10000"},
    {"[0.02, 0.03, 0.04]", "[0.02, 0.03]",
     "5:18: multirotor.inertia_kg_m2 has 2 elements: expected [xx, yy, zz] or the rows of a 3 x 3 matrix in kg m2 from "
     "1e-10 to 100000"},
    {"[0.02, 0.03, 0.04]", "0.02",
     "5:18: multirotor.inertia_kg_m2 is '0.02': expected [xx, yy, zz] or the rows of a 3 x 3 matrix in kg m2 from "
     "1e-10 to 100000"},
    {"[0.02, 0.03, 0.04]", "[0.02, 0.03, 0.06]",
     "5:18: multirotor.inertia_kg_m2 has the principal moments 0.02, 0.03 and 0.06 kg m2, which no body has: expected "
     "the largest to be at most the sum of the others, 0.05"},
    {"[0.02, 0.03, 0.04]", "[[0.02, 0, 0], [0.01, 0.03, 0], [0, 0, 0.04]]",
     "5:18: multirotor.inertia_kg_m2 is no symmetric matrix: expected the same number in row 2, column 1 as in row 1, "
     "column 2, the negative product of inertia of these axes"},
    {"[0.02, 0.03, 0.04]", "[[0.02, 0, 0], [0, 0.03, 0]]",
     "5:18: multirotor.inertia_kg_m2 has 2 rows: expected [xx, yy, zz] or the rows of a 3 x 3 matrix in kg m2 from "
     "1e-10 to 100000"},
    {"[0.02, 0.03, 0.04]", "[2, 3, 4]",
     "5:18: multirotor.inertia_kg_m2 is more than its whole mass at the outermost rotor tips would have (0.3246 kg "
     "m2)"},
    {"spin: [1, -1, 1, -1]", "spin: [1, -1, 1]",
     "11:9: rotors.spin has 3 numbers: expected 4, one for each rotor of positions_m"},
    {"spin: [1, -1, 1, -1]", "spin: [1, 0.5, 1, -1]", "11:9: rotors.spin has 0.5: expected 1 or -1"},
    {"spin: [1, -1, 1, -1]", "spin: [1, 1, 1, 1]",
     "11:9: rotors.spin gives torques that cannot turn the vehicle in yaw without turning it in roll or pitch, or "
     "changing its thrust: expected rotors of both spins around the vehicle, with a torque_ratio_m above 0, or axes "
     "that are tilted sideways"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: 0.02\n  axes: [[0, 0, 1]]",
     "13:9: rotors.axes has 1 direction: expected 4, one for each rotor of positions_m"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: 0.02\n  axes: [[0, 0, 1], [0, 0, 0], [0, 0, 1], [0, 0, 1]]",
     "13:9: rotors.axes of rotor 2 has no direction: expected a vector other than [0, 0, 0]"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: 0.02\n  axes: [[0, 0, 1], [0, 0, 1e-170], [0, 0, 1], [0, 0, 1]]",
     "13:9: rotors.axes of rotor 2 has no direction: expected a vector other than [0, 0, 0]"},
    {"torque_ratio_m: 0.02", "torque_ratio_m: [0.02, 0.02]",
     "12:19: rotors.torque_ratio_m has 2 numbers: expected 4, one for each rotor of positions_m"},
    {"[[0.2, 0.2, 0], [-0.2, 0.2, 0], [-0.2, -0.2, 0], [0.2, -0.2, 0]]",
     "[[0.2, 0.2, 0], [-0.2, -0.2, 0], [0.1, 0.1, 0], [-0.1, -0.1, 0]]",
     "10:16: rotors.positions_m gives the rotors no lever in roll or in pitch: expected hubs that do not lie on one "
     "line"},
    {"[[0.2, 0.2, 0], [-0.2, 0.2, 0], [-0.2, -0.2, 0], [0.2, -0.2, 0]]",
     "[[0.5, 0.2, 0], [0.1, 0.2, 0], [0.1, -0.2, 0], [0.5, -0.2, 0]]",
     "10:16: rotors.positions_m would need rotor 1 to pull downwards in a hover: expected the multirotor's centre of "
     "mass, [0, 0, 0], between the hubs"},
    {"max_thrust_n: 12", "max_thrust_n: 5",
     "13:17: rotors.max_thrust_n lifts 20 N with 4 rotors, which cannot carry the weight of 22.56 N, arm included: "
     "2.555 N are missing"},
    {"max_thrust_n: 12", "max_thrust_n: 12\n  min_thrust_n: 6",
     "14:17: rotors.min_thrust_n lifts 24 N with 4 rotors, more than the weight of 22.56 N: the vehicle could not "
     "descend"},
    {"max_thrust_n: 12", "max_thrust_n: 12\n  min_thrust_n: [0, 0, 13, 0]",
     "14:17: rotors.min_thrust_n is 13 for rotor 3: expected less than max_thrust_n, which is 12"},
    {"max_thrust_n: 12", "max_thrust_n: 12\n  time_constant_s: 0.001",
     "14:20: rotors.time_constant_s is 0.001: expected 0 for no lag, or at least half a control tick, 0.005 s"},
    {"axis: [0, 1, 0]", "axis: [0, 0, 0]",
     "17:38: arm.links[0].axis has no direction: expected a vector other than [0, 0, 0]"},
    {"axis: [0, 1, 0]", "axis: [0, 1e-170, 0]",
     "17:38: arm.links[0].axis has no direction: expected a vector other than [0, 0, 0]"},
    {"limits_deg: [-120, 120]", "limits_deg: [120, -120]",
     "18:59: arm.links[0].limits_deg is [lower, upper]: expected the lower limit below the upper one, or both the "
     "same"},
    {"max_torque_nm: 2}", "max_torque_nm: 0.5}",
     "18:87: arm.links[0].max_torque_nm is 0.5, too little to hold the arm with joints at [0, 0] deg: expected at "
     "least 0.5394 Nm"},
    {"[[0.0001, 0, 0], [0, 0.001, 0.00005], [0, 0.00005, 0.001]]",
     "[[0.0001, 0.001, 0], [0.001, 0.001, 0], [0, 0, 0.001]]",
     "20:23: arm.links[1].inertia_kg_m2 has the principal moments -0.0005466, 0.001 and 0.001647 kg m2: expected three "
     "above 0; the products of inertia are too large"},
    {"capsule: {radius_m: 0.02, to_m: [0.3, 0, 0]}", "capsule: {radius_m: 0, to_m: [0.3, 0, 0]}",
     "21:35: arm.links[1].body[0].capsule.radius_m is 0: expected a number in m from 1e-06 to 100000"},
    {"  attitude: {kp: 3,", "  delay_s: 0.3\n  rate_hz: 1000\n  attitude: {kp: 3,",
     "27:12: controller.delay_s is 0.3: expected at most 64 control ticks, 0.064 s"},
    {"position: {kp: 2, kd: 2.4}", "type: lqr\n  position: {kp: 2, kd: 2.4}",
     "24:9: controller.type is 'lqr': expected one of model-inversion or px4-cascade"},
    {"yaw_rate_kp: 5", "yaw_rate_kp: -5",
     "27:60: controller.attitude.yaw_rate_kp is -5: expected a number from 0 to 10000"},
};

const Edit problem_edits[] = {
    {"y_m: [-5, 5]", "y_m: [5, -5]", "5:31: environment.bounds.y_m is [low, high]: expected low below high"},
    {"y_m: 1, z_m: 2, yaw", "y_m: 8, z_m: 2, yaw", "9:23: start.y_m is 8, outside the bounds: expected -5 to 5"},
    {"joints_deg: [20, -10]", "joints_deg: [20]",
     "9:59: start.joints_deg has 1 number: expected 2, one for each joint of the arm, or no such key"},
    {"joints_deg: [20, -10]", "joints_deg: [20, 95]",
     "9:59: start.joints_deg has 95 for joint 2, beyond its limits: expected -90 to 90"},
    {"z_m: 2, yaw_deg: 30, joints_deg: [20, -10]", "z_m: 0.56, yaw_deg: 30, joints_deg: [70, -10]",
     "9:1: start is 0.02444 m from the obstacle 'ground', nearer than planner.safety_margin_m, 0.05: move the start or "
     "the obstacle"},
    {"x_m: -4, y_m: 1", "x_m: 4, y_m: 2.6",
     "9:1: start is in collision with the obstacle 'pole': move the start or the obstacle"},
    {"joints_deg: [20, -10]", "attitude: [0, 0, 0, 0]",
     "9:57: start.attitude has no direction: expected a quaternion [w, x, y, z]; [1, 0, 0, 0] is level"},
    {"joints_deg: [20, -10]", "attitude: [1e-170, 0, 0, 0]",
     "9:57: start.attitude has no direction: expected a quaternion [w, x, y, z]; [1, 0, 0, 0] is level"},
    {"joints_deg: [20, -10]", "rotor_thrust_n: [9], controller_memory: [1, 2]",
     "9:63: start.rotor_thrust_n has 1 numbers: expected 4, one for each rotor\n9:87: start.controller_memory has 2 "
     "numbers: expected 25, as many as robot.controller remembers"},
    {"joints_deg: [20, -10]", "reference: {position: [0, 0, 2, 0, 0, 0], velocity: [0, 0], acceleration: [0]}",
     "9:99: start.reference.velocity has 2 numbers: expected 6, one for each of x, y, z, yaw and the joints\n9:121: "
     "start.reference.acceleration has 1 numbers: expected 6, one for each of x, y, z, yaw and the joints"},
    {"joints_deg: [20, -10]", "velocity_m_s: [3, 0, 4]",
     "9:61: start.velocity_m_s makes a start speed of 5 m/s: expected at most motion.max_speed_m_s, 2"},
    {"joints_deg: [20, -10]", "joint_rates_rad_s: [0, 2]",
     "9:66: start.joint_rates_rad_s has 2, faster than motion.max_joint_rate_deg_s: expected at most 0.7854 in size"},
    {"direction: [0, 0, 1]", "direction: [0, 0, 0]",
     "11:73: goal.end_effector.direction has no direction: expected a vector other than [0, 0, 0], or null"},
    {"direction: [0, 0, 1]", "direction: [0, 1e-170, 0]",
     "11:73: goal.end_effector.direction has no direction: expected a vector other than [0, 0, 0], or null"},
    {"position_m: [3, -2, 2.5]", "position_m: [3, -2, 9]",
     "11:30: goal.end_effector.position_m is out of reach: from anywhere within the bounds the end effector, which "
     "gets 0.55 m from the multirotor's centre of mass, misses it by 3.35 m; widen environment.bounds or move the "
     "goal"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}", "configuration: {}",
     "11:3: goal.configuration is free in every coordinate: expected at least one of x_m, y_m, z_m, yaw_deg or "
     "joints_deg"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "configuration: {joints_deg: [1, 2, 3]}",
     "11:31: goal.configuration.joints_deg has 3 numbers: expected 2, one for each joint of the arm, or no such key"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}", "configuration: {y_m: 7}",
     "11:24: goal.configuration.y_m is 7, outside the bounds: expected -5 to 5"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "camera: {target_m: [3, 0, 2], distance_m: [2, 1]}",
     "11:45: goal.camera.distance_m is [nearest, farthest]: expected the nearest below the farthest"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "contact: {obstacle: post, force_n: 5}",
     "11:23: goal.contact.obstacle is 'post', and no obstacle has that name: expected ground or pole"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "pose: {position_m: [3, -2, 2.5]}",
     "11:3: goal.pose.rpy_deg is missing: expected [roll, pitch, yaw] in deg from -360 to 360"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "contact: {obstacle: pole, force_n: 5, position_m: [4, 0, 2]}",
     "11:53: goal.contact.position_m is farther than tolerance_m, 0.1, from the obstacle 'pole': expected a point of "
     "its surface, or null for any"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "contact: {obstacle: pole, force_n: 5, part: wrist}",
     "11:47: goal.contact.part is 'wrist': expected one of frame or end_effector"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "camera: {target_m: [3, 0, 9], distance_m: [1, 2]}",
     "11:22: goal.camera.target_m is out of reach: from anywhere within the bounds the end effector, which gets 0.55 m "
     "from the multirotor's centre of mass, misses it by 1.45 m; widen environment.bounds or move the goal"},
    {"end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}",
     "camera: {target_m: [3, 0, 2], distance_m: [1, 2], direction: [0, 0, 1], view_cone_deg: 200}",
     "11:90: goal.camera.view_cone_deg is 200: expected a number in deg above 0 and at most 180"},
    {"direction: [0, 0, 1]", "direction: [0, 0, 1], direction_tolerance_deg: 0",
     "11:109: goal.end_effector.direction_tolerance_deg is 0: expected a number in deg above 0 and at most 180"},
    {"max_speed_m_s: 2", "yaw: sideways",
     "13:15: motion.yaw is 'sideways': expected one of free, hold, along or toward"},
    {"max_speed_m_s: 2", "yaw: hold, yaw_toward_m: [0, 0]",
     "13:21: motion.yaw_toward_m has a meaning only with yaw: toward: remove it"},
    {"{name: pole, ", "{name: ground, ",
     "8:14: environment.obstacles[1].name is 'ground' like an obstacle before it: expected a name used once"},
};

/// What stands where the sound problem has its goal. Errors in lists and choices are those of single goals.
constexpr std::string_view single_goal =
    "  end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}\n  hold_s: 5\n";

const Edit goal_edits[] = {
    {single_goal, "  any_of:\n    - camera: {target_m: [3, 0, 2], distance_m: [2, 1]}\n",
     "12:49: goal.any_of[0].camera.distance_m is [nearest, farthest]: expected the nearest below the farthest"},
    {single_goal, "  in_any_order:\n    - contact: {obstacle: post, force_n: 5}\n",
     "12:27: goal.in_any_order[0].contact.obstacle is 'post', and no obstacle has that name: expected ground or pole"},
    {single_goal,
     "  in_any_order:\n    - any_of:\n        - end_effector: {position_m: [3, -2, 2.5], direction: [0, 0, 0]}\n",
     "13:63: goal.in_any_order[0].any_of[0].end_effector.direction has no direction: expected a vector other than "
     "[0, 0, 0], or null"},
    {single_goal, "  - configuration: {y_m: 0}\n  - pose: {position_m: [3, -2, 2.5], rpy_deg: [0, 0, 400]}\n",
     "12:47: goal[1].pose.rpy_deg is 400: expected [roll, pitch, yaw] in deg from -360 to 360"},
    {single_goal, "  any_of:\n    - configuration: {y_m: 0}\n      hold_s: 0\n",
     "13:15: goal.any_of[0].hold_s is 0: expected a number in s from 1 to 3600"},
    {single_goal, "  any_of: []\n", "11:11: goal.any_of is empty: expected one element at least"},
    {single_goal, "  in_any_order: []\n", "11:17: goal.in_any_order is empty: expected one element at least"},
    {single_goal, "  in_any_order:\n    - configuration: {y_m: 0}\n  return_to: {x_m: 1, joints_deg: [1, 2, 3]}\n",
     "13:35: goal.return_to.joints_deg has 3 numbers: expected 2, one for each joint of the arm, or no such key"},
    {single_goal, "  in_any_order:\n    - configuration: {y_m: 0}\n  return_to: {hold_s: 2}\n",
     "13:3: goal.return_to is free in every coordinate: expected at least one of x_m, y_m, z_m, yaw_deg or joints_deg"},
    {single_goal, "  in_any_order:\n    - configuration: {y_m: 0}\n  energy_budget_j: 0\n",
     "13:20: goal.energy_budget_j is 0: expected a number in J above 0 and at most 1000000000000, or null"},
    {single_goal, "  configuration: {y_m: 0}\n  return_to: {x_m: 1}\n",
     "12:3: goal.return_to has a meaning only with in_any_order: remove it"},
    {single_goal, "  camera: {target_m: [3, 0, 2], distance_m: [1, 2]}\n  contact: {obstacle: pole, force_n: 5}\n",
     "12:3: goal has both camera and contact: expected exactly one of configuration, end_effector, pose, camera, "
     "contact, any_of or in_any_order"},
};

}  // namespace

TEST_CASE("a malformed robot in space is an error in its own file") {
    check(robot_edits, "robot.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), good_space_problem, edited(good_space_robot, from, to));
    });
}

TEST_CASE("a malformed problem in space is an error at its key") {
    check(problem_edits, "problem.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), edited(good_space_problem, from, to), good_space_robot);
    });
}

TEST_CASE("more targets in space than fifty, and more goals than 64, are an error") {
    const auto errors_with = [](const std::string& before, const std::string& each, int count) {
        std::string goals = before;
        for (int i = 0; i < count; ++i) {
            goals += each;
        }
        return space_errors(TestFolder(), edited(good_space_problem, single_goal, goals), good_space_robot);
    };
    const std::string target = "    - configuration: {y_m: 0}\n";
    CHECK(errors_with("  in_any_order:\n", target, 50) == "sound");
    CHECK_THAT(errors_with("  in_any_order:\n", target, 51),
               Catch::Contains("goal.in_any_order has 51 goals: expected at most 50"));
    CHECK_THAT(errors_with("", target, 65), Catch::Contains("goal has 65 goals: expected at most 64"));
    CHECK_THAT(errors_with("  any_of:\n", target, 65),
               Catch::Contains("goal.any_of has 65 goals: expected at most 64"));
}

TEST_CASE("a malformed goal in space is an error at its key in a list, a choice or goals in any order") {
    check(goal_edits, "problem.yaml", [](auto from, auto to) {
        return space_errors(TestFolder(), edited(good_space_problem, from, to), good_space_robot);
    });
}

TEST_CASE("keys of a robot in space and of one in a vertical plane are not mixed") {
    const TestFolder folder;
    const std::string mixed =
        edited(good_space_robot, "  end_effector_m: [0.3, 0, 0]", "  end_effector_m: [0.3, 0, 0]\n  length_m: 0.5");
    CHECK(space_errors(folder, good_space_problem, mixed) ==
          "robot.yaml:5:3: multirotor.inertia_kg_m2 is a key of a robot in space, and arm.length_m in line 23 one of a "
          "robot in a vertical plane: expected keys of one kind");
    CHECK(
        space_errors(folder, edited(good_space_problem, "bounds: {x_m", "plane: {heading_deg: 3}\n  bounds: {x_m"),
                     good_space_robot) ==
        "problem.yaml:6:26: environment.bounds.y_m is a key of a problem in space, and environment.plane in line 5 one "
        "of a problem in a vertical plane: expected keys of one kind");
}

TEST_CASE("robots and problems of a vertical plane and of space do not fit each other") {
    const TestFolder folder;
    CHECK(space_errors(folder, good_space_problem, good_robot) ==
          "robot.yaml:5:3: multirotor.pitch_inertia_kg_m2 is a key of a robot in a vertical plane, and this is one in "
          "space: expected a robot with multirotor.inertia_kg_m2 and arm.links, or a problem without "
          "environment.bounds.y_m");
    CHECK(folder.errors_of(good_problem, good_space_robot) ==
          "robot.yaml:5:3: multirotor.inertia_kg_m2 is a key of a robot in space, and this is one in a vertical plane: "
          "expected a robot with multirotor.pitch_inertia_kg_m2, or a problem in space, which environment.bounds.y_m "
          "makes it");
}

TEST_CASE("what takes problems in a vertical plane says so of a problem in space") {
    const TestFolder folder;
    CHECK(folder.errors_of(good_space_problem, good_space_robot) ==
          "problem.yaml:5:26: environment.bounds.y_m makes this a problem in space: expected one in a vertical plane, "
          "whose bounds have no y_m");
    CHECK(is_space_problem_file(folder / "problem.yaml"));
    CHECK(is_space_robot_file(folder / "robot.yaml"));
    folder.write("problem.yaml", good_problem);
    folder.write("robot.yaml", good_robot);
    CHECK_FALSE(is_space_problem_file(folder / "problem.yaml"));
    CHECK_FALSE(is_space_robot_file(folder / "robot.yaml"));
    CHECK_FALSE(is_space_robot_file(folder / "missing.yaml"));
}
