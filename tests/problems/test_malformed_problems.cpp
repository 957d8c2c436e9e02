#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view pole = "name: pole, cylinder: {radius_m: 0.2, length_m: 5, center_m: [4, 3, 2.5]}";
constexpr std::string_view size = "size_m: [30, 20, 1]";
constexpr std::string_view tip = "end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}";
constexpr std::string_view tip_and_hold = "  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n  hold_s: 5\n";
constexpr std::string_view goal = "goal:\n  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n  hold_s: 5\n";
constexpr std::string_view start = "start: {x_m: -4, z_m: 2, arm_deg: 90}";

const Edit edits[] = {
    {"start: {x_m: -4", "strat: {x_m: -4", "12:1: unknown key 'strat' at the top: did you mean 'start'?"},
    {"hold_s: 5", "hold: 5", "15:3: unknown key 'hold' in goal: its unit is missing; expected hold_s"},
    {"tolerance_m: 0.1", "tolerance_mm: 100",
     "14:36: unknown key 'tolerance_mm' in goal.end_effector: its unit is wrong; expected tolerance_m"},
    {"tolerance_m: 0.1", "tolerance: 0.1",
     "14:36: unknown key 'tolerance' in goal.end_effector: its unit is missing; expected tolerance_m"},
    {"arm_deg: 90", "arm_rad: 1.57", "12:26: unknown key 'arm_rad' in start: its unit is wrong; expected arm_deg"},
    {"arm_deg: 90", "color: red",
     "12:1: start.arm_deg is missing: expected a number in deg from -3600 to 3600\n12:26: unknown key 'color' in "
     "start: expected x_m, z_m, arm_deg, pitch_deg, vx_m_s, vz_m_s, pitch_rate_deg_s, arm_rate_deg_s, rotor_thrust_n, "
     "controller_memory or reference"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {aero: {ceiling_scale: {sd: -0.1}}}",
     "13:37: uncertainty.aero.ceiling_scale has a negative sd: expected a standard deviation of at least 0"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {vehicle: {mass_scale: {range: [0.1, -0.1]}}}",
     "13:37: uncertainty.vehicle.mass_scale has a range upside down: expected [low, high]"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {sensing: {gyro_noise_rad_s: {range: [0, 1]}}}",
     "13:44: uncertainty.sensing.gyro_noise_rad_s has the unknown form 'range': expected 0 or {sd: number} in rad/s "
     "from "
     "0 to 10"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {wind: {gust_m_s: 0.3}}",
     "13:32: uncertainty.wind.gust_m_s is '0.3': expected 0 or {sd: number} in m/s from 0 to 30"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {aero: {ceiling_scale: {sd: 0.4}}}",
     "13:37: uncertainty.aero.ceiling_scale has an sd so large that 3 of it leave the range: expected 0 or {sd: "
     "number} "
     "or {range: [low, high]} from -0.9 to 0.9"},
    {"x_m: 3, z_m: 2.5", "x_m: 3, y_m: 0.5, z_m: 2.5",
     "14:26: unknown key 'y_m' in goal.end_effector: vehicle and arm move in a vertical plane, in which x_m and z_m "
     "are "
     "coordinates; environment.plane (origin_m, heading_deg) places it in the scene"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {weather: {}}",
     "13:15: unknown key 'weather' in uncertainty: expected aero, vehicle, sensing or wind"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {vehicle: {rotor_time_constant_s: {sd: 0.01}}}",
     "13:48: uncertainty.vehicle.rotor_time_constant_s is uncertain for rotors without a lag: give the robot its "
     "rotors.time_constant_s first"},
    {start, "start: {x_m: -4, z_m: 2, arm_deg: 90}\nuncertainty: {}\nplanner: {max_failure_probability: 0}",
     "14:36: planner.max_failure_probability is 0: expected a number from 0.0001 to 0.5\n18:1: planner is written "
     "twice: "
     "expected once, as in line 14"},
    {"seed: 1", "seed: 1, worlds: 4", "16:81: planner.worlds has a meaning only with an uncertainty: remove it"},
    {"x_m: -4", "x_m: left", "12:14: start.x_m is 'left': expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: \"-4\"",
     "12:14: start.x_m is text in quotes, \"-4\": expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: ", "12:14: start.x_m has no value: expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: [-4]", "12:14: start.x_m is a list: expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: {is: -4}", "12:14: start.x_m is a group of keys: expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: 4 m", "12:14: start.x_m is '4 m': expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: 4,5", "12:16: unknown key '5': numbers have a decimal point; write x_m: 4.5"},
    {"  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n",
     "  any_order: [{end_effector: {x_m: 3, z_m: 2.5}}]\n  energy_budget_j: 1000\n",
     "14:3: unknown key 'any_order' in goal: did you mean 'in_any_order'?"},
    {"x_m: -4", "x_m: 0x10", "12:14: start.x_m is '0x10': expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: 1_000", "12:14: start.x_m is '1_000': expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: .nan", "12:14: start.x_m is not finite: expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: -.inf", "12:14: start.x_m is not finite: expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: 1e999", "12:14: start.x_m is '1e999': expected a number in m from -100000 to 100000"},
    {"x_m: -4", "x_m: 1e9", "12:14: start.x_m is 1000000000: expected a number in m from -100000 to 100000"},
    {"arm_deg: 90", "arm_deg: 4000", "12:35: start.arm_deg is 4000: expected a number in deg from -3600 to 3600"},
    {size, "size_m: [30, 20]",
     "7:36: environment.obstacles[0].box.size_m has 2 elements: expected [x, y, z] in m from 1e-06 to 100000"},
    {size, "size_m: [30, 20, 1, 1]",
     "7:36: environment.obstacles[0].box.size_m has 4 elements: expected [x, y, z] in m from 1e-06 to 100000"},
    {size, "size_m: [30, 20, one]",
     "7:45: environment.obstacles[0].box.size_m is 'one': expected [x, y, z] in m from 1e-06 to 100000"},
    {size, "size_m: 30",
     "7:36: environment.obstacles[0].box.size_m is '30': expected [x, y, z] in m from 1e-06 to 100000"},
    {size, "size_m: [30, 20, 0]",
     "7:36: environment.obstacles[0].box.size_m is 0: expected [x, y, z] in m from 1e-06 to 100000"},
    {size, "size_m: [30, 20, .inf]",
     "7:45: environment.obstacles[0].box.size_m is not finite: expected [x, y, z] in m from 1e-06 to 100000"},
    {"radius_m: 0.2", "radius_m: -0.2",
     "8:41: environment.obstacles[1].cylinder.radius_m is -0.2: expected a number in m from 1e-06 to 100000"},
    {"length_m: 5, ", "",
     "8:20: environment.obstacles[1].cylinder.length_m is missing: expected a number in m from 1e-06 to 100000"},
    {"length_m: 5, ", "length_m: 5, axis: [0, 0, 0], ",
     "8:65: environment.obstacles[1].cylinder.axis has no direction: expected a vector other than [0, 0, 0]"},
    {"length_m: 5, ", "length_m: 5, axis: [0, 0, 1e-170], ",
     "8:65: environment.obstacles[1].cylinder.axis has no direction: expected a vector other than [0, 0, 0]"},
    {", center_m: [4, 3, 2.5]", "",
     "8:20: environment.obstacles[1].cylinder.center_m is missing: expected [x, y, z] in m from -100000 to 100000"},
    {"cylinder: {", "cilinder: {",
     "8:20: unknown key 'cilinder' in environment.obstacles[1]: did you mean 'cylinder'?"},
    {pole, "name: pole", "8:7: environment.obstacles[1] needs exactly one of box, cylinder, sphere, mesh or octomap"},
    {"name: pole, cylinder: {", "name: pole, sphere: {radius_m: 1, center_m: [4, 3, 2]}, cylinder: {",
     "8:64: environment.obstacles[1] has both sphere and cylinder: expected exactly one of box, cylinder, sphere, mesh "
     "or octomap"},
    {pole, "name: girder, mesh: {file: girder.stl}",
     "8:35: environment.obstacles[1].mesh.file 'girder.stl' cannot be read: there is no such file"},
    {pole, "name: scan, octomap: {file: pier.bt}",
     "8:36: environment.obstacles[1].octomap.file 'pier.bt' cannot be read: there is no such file"},
    {"name: pole", "name: ground",
     "8:14: environment.obstacles[1].name is 'ground' like an obstacle before it: expected a name used once"},
    {"{name: pole, cylinder: {radius_m: 0.2, length_m: 5, center_m: [4, 3, 2.5]}}", "pole",
     "8:7: environment.obstacles[1] is 'pole': expected a group of keys"},
    {start, "start: {x_m: -4}",
     "12:1: start.z_m is missing: expected a number in m from -100000 to 100000\n12:1: start.arm_deg is missing: "
     "expected a number in deg from -3600 to 3600"},
    {"start: {x_m: -4, z_m: 2, arm_deg: 90}\n", "", "1:1: start is missing: expected a group of keys"},
    {start, "start: [-4, 2, 90]", "12:8: start is a list: expected a group of keys"},
    {"start: {x_m: -4", "start: {x_m: -3, x_m: -4", "12:18: start.x_m is written twice: expected once, as in line 12"},
    {"name: test", "name: ../../etc/passwd",
     "2:7: name is '../../etc/passwd': expected 1 to 64 letters, digits, '_' or '-'"},
    {"name: test", "name: nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn",
     "2:7: name is 'nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn...': expected 1 to 64 letters, digits, '_' or "
     "'-'"},
    {"name: test", "name: [a]", "2:7: name is a list: expected 1 to 64 letters, digits, '_' or '-'"},
    {"schema: downwash/problem/v1", "schema: downwash/problem/v2",
     "1:9: schema is 'downwash/problem/v2': expected downwash/problem/v1, no other is read"},
    {"schema: downwash/problem/v1", "schema: 1", "1:9: schema is '1': expected downwash/problem/v1, no other is read"},
    {"schema: downwash/problem/v1\n", "", "1:1: schema is missing: expected downwash/problem/v1"},
    {"robot: robot.yaml", "robot: robots/missing.yaml",
     "3:8: robot 'robots/missing.yaml' cannot be read: there is no such file"},
    {"robot: robot.yaml", "robot: \"\"", "3:8: robot is '': expected a group of keys or the path of a file"},
    {"robot: robot.yaml", "robot: 7", "3:8: robot '7' cannot be read: there is no such file"},
    {"robot: robot.yaml", "robot: [robot.yaml]",
     "3:8: robot is a list: expected a group of keys or the path of a file"},
    {"  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n", "", "13:1: goal needs exactly one of <goals>"},
    {"  end_effector: {", "  configuration: {x_m: 1}\n  end_effector: {",
     "15:3: goal has both configuration and end_effector: expected exactly one of <goals>"},
    {tip_and_hold, "  any_of: []\n", "14:11: goal.any_of is empty: expected one element at least"},
    {"  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n",
     "  any_of: [{end_effector: {x_m: 3, z_m: 2.5}}, {hold_s: 2}]\n",
     "14:48: goal.any_of[1] needs exactly one of <stops>\n15:3: goal.hold_s has a meaning only "
     "without any_of and in_any_order: remove it"},
    {tip_and_hold,
     "  any_of: [{end_effector: {x_m: 3, z_m: 2.5}}, {configuration: {x_m: 30, tolerance_x_m: 0, hold_s: 2}}]\n",
     "14:89: goal.any_of[1].configuration.tolerance_x_m is 0: expected a number in m above 0 and at most 100, or "
     "null\n14:92: unknown key 'hold_s' in goal.any_of[1].configuration: expected x_m, z_m, arm_deg, tolerance_m, "
     "tolerance_x_m, tolerance_z_m or tolerance_deg"},
    {tip_and_hold, "  any_of: [{end_effector: {x_m: 3, z_m: 2.5}}, {configuration: {x_m: 30}}]\n",
     "14:70: goal.any_of[1].configuration.x_m is 30, outside the bounds: expected -6 to 6"},
    {tip, "configuration: {z_m: 3, tolerance_x_m: 0.1}",
     "14:42: goal.configuration.tolerance_x_m has a meaning only with x_m: remove it"},
    {goal, "goal: {in_any_order: []}\n", "13:22: goal.in_any_order is empty: expected one element at least"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}, {any_of: [{configuration: {x_m: 1}}, {hold_s: 0}]}]\n",
     "14:82: goal.in_any_order[1].any_of[1] needs exactly one of <stops>\n14:91: "
     "goal.in_any_order[1].any_of[1].hold_s is 0: expected a number in s from 1 to 3600"},
    {tip_and_hold,
     "  in_any_order: [{configuration: {x_m: 1}}, {any_of: [{configuration: {x_m: 1}}, {configuration: {x_m: 30}}]}]\n",
     "14:104: goal.in_any_order[1].any_of[1].configuration.x_m is 30, outside the bounds: expected -6 to 6"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}]\n  return_to: {x_m: 9}\n  energy_budget_j: 0\n",
     "16:20: goal.energy_budget_j is 0: expected a number in J above 0 and at most 1000000000000, or null"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}]\n  return_to: {x_m: 9}\n",
     "15:20: goal.return_to.x_m is 9, outside the bounds: expected -6 to 6"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}, {contact: {obstacle: wall, force_n: 2}}]\n",
     "14:66: goal.in_any_order[1].contact.obstacle is 'wall': expected the name of an obstacle"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}, {force: {obstacle: wall, force_n: 2}}]\n",
     "14:45: goal.in_any_order[1] needs exactly one of <targets>\n14:46: unknown key 'force' in goal.in_any_order[1]: "
     "expected <keys of a target>"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}]\n  contact: {obstacle: wall, force_n: 2}\n",
     "15:3: goal has both in_any_order and contact: expected exactly one of <goals>"},
    {tip_and_hold, "  in_any_order: [{configuration: {x_m: 1}}]\n  return_to: {hold_s: 2}\n",
     "15:3: goal.return_to is free in every coordinate: expected at least one of x_m, z_m or arm_deg"},
    {"  hold_s: 5\n", "  hold_s: 5\n  return_to: {x_m: 1}\n",
     "16:3: goal.return_to has a meaning only with in_any_order: remove it"},
    {goal, "goal: []\n", "13:7: goal is empty: expected one element at least"},
    {goal, "goal: [{end_effector: {x_m: 3, z_m: 9}}, {any_of: []}, {configuration: {x_m: 3}, hold_s: 0}]\n",
     "13:42: goal[1] needs exactly one of <stops>\n13:43: unknown key 'any_of' in goal[1]: "
     "expected <keys of a stop>\n13:90: goal[2].hold_s is 0: expected a number in s from 1 to "
     "3600"},
    {goal, "goal: [{end_effector: {x_m: 3, z_m: 9}}, {configuration: {x_m: 3}}]\n",
     "13:9: goal[0].end_effector is out of reach: from anywhere within the bounds the arm of 1.2 m misses it by 2.7 m; "
     "widen environment.bounds or move the goal"},
    {goal,
     "goal: [{configuration: {x_m: 1}, hold_s: 3000}, {configuration: {x_m: 2}, hold_s: 600}, {configuration: {x_m: "
     "3}}]\n",
     "13:1: goal is held for 3600 s before its last entry: expected less than 3600 s, 360000 control ticks, in one "
     "plan"},
    {tip, "configuration: {tolerance_m: 0.1}",
     "14:3: goal.configuration is free in every coordinate: expected at least one of x_m, z_m or arm_deg"},
    {"hold_s: 5", "hold_s: 0.5", "15:11: goal.hold_s is 0.5: expected a number in s from 1 to 3600"},
    {"cheeseman-bennett", "cheesman-bennett",
     "10:19: aero.ground.model is 'cheesman-bennett': expected one of <models>; did you mean 'cheeseman-bennett'?"},
    {"{model: cheeseman-bennett}", "{model: cheeseman-bennett, k1: 3}",
     "10:38: aero.ground.k1 has a meaning only with the model sanchez-cuevas: remove it"},
    {"{model: cheeseman-bennett}", "off", "10:11: aero.ground is 'off': expected a group of keys or none"},
    {"k1: 6.9", "k1: 0", "11:40: aero.ceiling.k1 is 0: expected a number above 0 and at most 1000000"},
    {"variant: mp-arm-ada", "variant: mp-arm-aad",
     "16:20: planner.variant is 'mp-arm-aad': expected one of mp-arm, mp-arm-da or mp-arm-ada; did you mean "
     "'mp-arm-ada'?"},
    {"algorithm: rrt-star", "algorithm: rrt_star",
     "16:43: planner.algorithm is 'rrt_star': expected one of <algorithms>; did you mean 'rrt-star'?"},
    {"algorithm: rrt-star", "algorithm: bit-star",
     "16:43: planner.algorithm is 'bit-star', which does not plan for mp-arm-ada: expected <algorithms over flights>; "
     "did you mean 'rrt-star'?"},
    {"objective: energy", "objective: comfort",
     "16:64: planner.objective is 'comfort': expected one of <objectives>, or a group of keys"},
    {"objective: energy", "objective: {energy: 1, times: 2, length: -1}",
     "16:76: unknown key 'times' in planner.objective: did you mean 'time'?\n16:94: planner.objective.length is -1: "
     "expected a number from 0 to 1000000000"},
    {"objective: energy", "objective: {energy: 0, time: 0}",
     "16:64: planner.objective has no weight above 0: expected one at least"},
    {"objective: energy", "objective: {}", "16:64: planner.objective has no weight above 0: expected one at least"},
    {"objective: energy", "objective: [energy, time]",
     "16:64: planner.objective is a list: expected one of <objectives>, or a group of keys"},
    {"seed: 1", "seed: 1, safety_margin: 0.1, colour: 7, max_iteration: 4",
     "16:81: unknown key 'safety_margin' in planner: its unit is missing; expected safety_margin_m\n16:101: unknown "
     "key 'colour' in planner: expected variant, algorithm, objective, time_limit_s, max_iterations, seed, "
     "safety_margin_m, collision_checker, max_saturation, max_pitch_rate_deg_s, check_execution, worlds, certify, "
     "max_failure_probability, "
     "confidence or parameters\n16:112: unknown key "
     "'max_iteration' "
     "in planner: did you mean 'max_iterations'?"},
    {"aero:\n", "aero: none\naero2:\n", "10:1: unknown key 'aero2' at the top: did you mean 'aero'?"},
    {"seed: 1", "seed: -1", "16:78: planner.seed is '-1': expected a whole number from 0 to 4294967295"},
    {"seed: 1", "seed: 1.5", "16:78: planner.seed is '1.5': expected a whole number from 0 to 4294967295"},
    {"seed: 1", "seed: 5000000000", "16:78: planner.seed is 5000000000: expected a whole number from 0 to 4294967295"},
    {"seed: 1", "seed: 1, max_iterations: 0",
     "16:97: planner.max_iterations is 0: expected a whole number from 1 to 1e+15, or null"},
    {"seed: 1", "seed: 1, max_saturation: 0.5",
     "16:97: planner.max_saturation is 0.5: expected a number from 1 to 1000"},
    {"seed: 1", "seed: 1, max_pitch_rate_deg_s: 0",
     "16:103: planner.max_pitch_rate_deg_s is 0: expected a number in deg/s from 0.001 to 100000, or null"},
    {"aero:\n", "motion: {max_thrust_ratio: 1, max_pitch_rate_deg_s: 0}\naero:\n",
     "9:28: motion.max_thrust_ratio is 1: expected a number from 1.001 to 100, or null\n9:53: "
     "motion.max_pitch_rate_deg_s is 0: expected a number in deg/s from 0.1 to 36000, or null"},
    {"seed: 1", "seed: 1, time_limit_s: 0",
     "16:95: planner.time_limit_s is 0: expected a number in s above 0 and at most 1000000, or null"},
    {"seed: 1", "seed: !!int 1", "16:78: a tag (!...) is not understood here: remove it"},
    {"seed: 1", "seed: 1, ? [a] : 2", "16:83: a key of planner is no word: expected 'name: value'"},
    {"seed: 1", "seed: 1, parameters: {goal_bais: 0.2}",
     "16:94: unknown key 'goal_bais' in planner.parameters: did you mean 'goal_bias'?"},
    {"seed: 1", "seed: 1, parameters: {goal_bias: 1.5}",
     "16:105: planner.parameters.goal_bias is 1.5: expected a number from 0 to 1"},
    {"seed: 1", "seed: 1, parameters: {batch_size: 1.5}",
     "16:106: planner.parameters.batch_size is 1.5: expected a whole number"},
    {"seed: 1", "seed: 1, parameters: {pruning_radius: 0.2}",
     "16:94: planner.parameters.pruning_radius has a meaning only with sst: remove it"},
    {"seed: 1", "seed: 1, <<: 2",
     "16:81: merge keys (<<) are not read: expected the keys themselves; an alias (*name) may stand for a whole value"},
};

}  // namespace

TEST_CASE("a malformed problem is an error with place, reason and remedy") {
    CHECK(TestFolder().errors_of(good_problem, good_robot) == "sound");
    check(edits, "problem.yaml", [](auto from, auto to) { return errors_after(TestFolder(), from, to); });
}
