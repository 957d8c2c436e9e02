#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

const Edit edits[] = {
    {"  mass_kg: 4.5", "  mass: 4.5", "4:3: unknown key 'mass' in multirotor: its unit is missing; expected mass_kg"},
    {"  mass_kg: 4.5", "  mass_g: 4500",
     "4:3: unknown key 'mass_g' in multirotor: its unit is wrong; expected mass_kg"},
    {"  mass_kg: 4.5", "  mass_kg: 4.5 kg",
     "4:12: multirotor.mass_kg is '4.5 kg': expected a number in kg from 0.0001 to 10000"},
    {"  mass_kg: 4.5", "  mass_kg: 0", "4:12: multirotor.mass_kg is 0: expected a number in kg from 0.0001 to 10000"},
    {"arm: {length_m", "arm: {lenght_m", "13:7: unknown key 'lenght_m' in arm: did you mean 'length_m'?"},
    {"multirotor:", "multi_rotor:", "3:1: unknown key 'multi_rotor' at the top: did you mean 'multirotor'?"},
    {"schema: downwash/robot/v1\n", "", "1:1: schema is missing: expected 'schema: downwash/robot/v1' at the top"},
    {"schema: downwash/robot/v1", "schema: downwash/problem/v1",
     "1:9: schema is 'downwash/problem/v1': expected downwash/robot/v1, no other is read"},
    {"radius_m: 0.19\n", "radius_m: -0.19\n",
     "9:13: rotors.radius_m is -0.19: expected a number in m from 0.0001 to 10"},
    {"[0.3, 0.3, 0], ", "[0.3, 0.3], ",
     "10:17: rotors.positions_m has 2 elements: expected a list of [x, y, z] in m from -100 to 100"},
    {"[[0.3, 0.3, 0], [0.3, -0.3, 0], [-0.3, 0.3, 0], [-0.3, -0.3, 0]]", "0.3",
     "10:16: rotors.positions_m is '0.3': expected a list of [x, y, z] in m from -100 to 100"},
    {"[[0.3, 0.3, 0], [0.3, -0.3, 0], [-0.3, 0.3, 0], [-0.3, -0.3, 0]]", "[[0, 0, 0]]",
     "10:16: rotors.positions_m has 1 rotor: expected 2 to 8"},
    {"[[0.3, 0.3, 0], [0.3, -0.3, 0], [-0.3, 0.3, 0], [-0.3, -0.3, 0]]", "[[0, 0.3, 0], [0, -0.3, 0]]",
     "10:16: rotors.positions_m gives every rotor the same x: without a lever they cannot turn the vehicle in pitch; "
     "place rotors in front of and behind the centre of mass"},
    {"[0.3, 0.3, 0], ", "[0.3, 0.3, 0], [0.1, 0, 0], [0.1, 1, 0], [0.1, 2, 0], [-0.1, 0, 0], [-0.1, 1, 0], ",
     "10:16: rotors.positions_m has 9 rotors: expected 2 to 8"},
    {"[-0.3, 0.3, 0], [-0.3, -0.3, 0]", "[0.1, 0.3, 0], [0.1, -0.3, 0]",
     "10:16: rotors.positions_m has all rotors on one side of the centre of mass (x = 0): thrust that carries the "
     "weight would turn the vehicle over"},
    {"max_thrust_n: 28", "max_thrust_n: 11",
     "11:17: rotors.max_thrust_n gives 44 N with 4 rotors, which cannot lift the weight of 48.54 N: 4.543 N are "
     "missing; expected more than 12.14 N a rotor"},
    {"max_thrust_n: 28", "max_thrust_n: 28\n  min_thrust_n: 13",
     "12:17: rotors.min_thrust_n gives 52 N with 4 rotors, more than the weight of 48.54 N: the vehicle could not "
     "descend"},
    {"max_thrust_n: 28", "max_thrust_n: 28\n  min_thrust_n: 30",
     "12:17: rotors.min_thrust_n is 30: expected less than max_thrust_n, which is 28"},
    {"max_thrust_n: 28", "max_thrust_n: 28\n  time_constant_s: 0.001",
     "12:20: rotors.time_constant_s is 0.001: expected 0 for no lag, or at least half a control tick, 0.005 s"},
    {"max_thrust_n: 28", "max_thrust: 28",
     "11:3: unknown key 'max_thrust' in rotors: its unit is missing; expected max_thrust_n"},
    {"pitch_inertia_kg_m2: 0.2", "pitch_inertia_kg_m2: 20",
     "5:24: multirotor.pitch_inertia_kg_m2 is more than its whole mass at the outermost rotor tips would have (1.08 kg "
     "m2)"},
    {"inertia_kg_m2: 0.06", "inertia_kg_m2: 6",
     "13:75: arm.inertia_kg_m2 is more than the arm's whole mass at its full length would have (0.6808 kg m2)"},
    {"center_of_mass_m: 0.7", "center_of_mass_m: 1.3",
     "13:55: arm.center_of_mass_m is 1.3: expected at most the arm's length, 1.2 m"},
    {"  position: {kp: 2", "  type: own-law\n  horizontal: {position_kp: 1}\n  position: {kp: 2",
     "15:9: controller.type is 'own-law': expected one of model-inversion, cascaded-pid or lyapunov"},
    {"max_torque_nm: 12", "max_torque_nm: 3",
     "13:112: arm.max_torque_nm is 3, too little to hold the arm level: expected at least 3.089 Nm"},
    {"max_torque_nm: 12", "max_torque_nm: 12, wash: {scale: 1}",
     "13:116: arm.wash acts through the drag of the arm, and it has none: expected arm.drag as well"},
    {"max_torque_nm: 12", "max_torque_nm: 12, drag: {linear_n_s_m: 1}, wash: {scale: -1}",
     "13:155: arm.wash.scale is -1: expected a number from 0 to 10"},
    {"max_torque_nm: 12", "max_torque_nm: 12, limits_deg: [90, -90]",
     "13:128: arm.limits_deg is [90, -90]: expected [lower, upper], the lower limit below the upper one, or both the "
     "same"},
    {"max_torque_nm: 12", "max_torque_nm: 12, limits_deg: 90",
     "13:128: arm.limits_deg is '90': expected [lower, upper] in deg from -3600 to 3600, or null"},
    {"    - box: {size_m: [1, 1, 0.2], center_m: [0, 0, 0]}", "    []",
     "6:3: multirotor.body is empty: expected at least one box, cylinder or sphere that encloses the multirotor"},
    {"center_m: [0, 0, 0]", "center_m: [0, 0, 0], rpy_deg: [0, 0, 9]",
     "7:55: unknown key 'rpy_deg' in multirotor.body[0].box: expected size_m or center_m"},
    {"max_tilt_deg: 35", "max_tilt_deg: 90",
     "18:17: controller.max_tilt_deg is 90: expected a number in deg at least 0.01 and below 90"},
    {"max_tilt_deg: 35", "rate_hz: 5", "18:12: controller.rate_hz is 5: expected a number in Hz from 10 to 1000"},
    {"max_tilt_deg: 35", "rate_khz: 0.1",
     "18:3: unknown key 'rate_khz' in controller: its unit is wrong; expected rate_hz"},
    {"attitude: {kp: 8, ", "attitude: {kp: 8, rate_feed_forward: yes, ",
     "16:40: controller.attitude.rate_feed_forward is 'yes': expected true or false"},
    {"attitude: {kp: 8, ", "attitude: {kp: 8, k5: 8, ",
     "16:21: controller.attitude.kp is written twice: expected once, as in line 16"},
    {"  position: {kp: 2, kd: 2.6}", "  type: cascade\n  position: {kp: 2, kd: 2.6}",
     "15:9: controller.type is 'cascade': expected one of model-inversion, cascaded-pid or lyapunov"},
    {"  position: {kp: 2, kd: 2.6}", "  horizontal: {position_kp: 1}\n  position: {kp: 2, kd: 2.6}",
     "15:3: controller.horizontal has a meaning only with controller.type cascaded-pid or lyapunov: remove it"},
    {"  position: {kp: 2, kd: 2.6}", "  observer: {gain_1_s: 0}\n  position: {kp: 2, kd: 2.6}",
     "15:24: controller.observer.gain_1_s is 0: expected a number in 1/s from 0.001 to 10000"},
    {"  position: {kp: 2, kd: 2.6}", "  feed_forward: {offset_z: 0.1}\n  position: {kp: 2, kd: 2.6}",
     "15:18: unknown key 'offset_z' in controller.feed_forward: its unit is missing; expected offset_z_m"},
    {"  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: 30, kd: 11}",
     "  type: cascaded-pid\n  joint: {kp: -1}", "16:15: controller.joint.kp is -1: expected a number from 0 to 10000"},
    {"  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: 30, kd: 11}",
     "  type: lyapunov\n  vertical: {k: 3, k_rate: 0}",
     "16:28: controller.vertical.k_rate is 0: expected a number from 0.001 to 1000"},
    {"  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: 30, kd: 11}",
     "  type: lyapunov\n  vertical: {position_kp: 3}",
     "16:14: controller.vertical.position_kp has a meaning only with controller.type cascaded-pid: remove it"},
    {"attitude: {kp: 8, ", "attitude: {", "16:3: controller.attitude.kp is missing: expected a number from 0 to 10000"},
    {"position: {kp: 2, kd: 2.6}", "position: {Kp: 2, kd: 2.6}",
     "15:14: unknown key 'Kp' in controller.position: did you mean 'kp'?"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty: {aero: {ceiling_scale: {sd: 0.1}}}",
     "19:15: unknown key 'aero' in uncertainty: it belongs in the problem file, as uncertainty.aero"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty:\n  vehicle: {mass_scale: 0}\n  wind: {gust_m_s: {sd: 0.3}}",
     "21:3: unknown key 'wind' in uncertainty: it belongs in the problem file, as uncertainty.wind"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty: {vehicle: {weight: 0}, weather: 0}",
     "19:25: unknown key 'weight' in uncertainty.vehicle: expected mass_scale, inertia_scale, arm_mass_scale, "
     "com_offset_m, thrust_scale, rotor_thrust_scale, rotor_time_constant_s, delay_s, lateral_error_m or "
     "arm_wash_scale\n19:37: unknown key 'weather' "
     "in uncertainty: expected vehicle or sensing"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nplanner: {seed: 1}",
     "19:1: unknown key 'planner' at the top: it belongs in the problem file, as planner"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty: none",
     "19:14: uncertainty is 'none': expected a group of keys"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty: {sensing: {pitch_bias_deg: {sd: 11}}}",
     "19:41: uncertainty.sensing.pitch_bias_deg has an sd so large that 3 of it leave the range: expected 0 or {sd: "
     "number} or {range: [low, high]} in deg from -30 to 30"},
    {"controller:\n  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: 30, kd: 11}\n  "
     "max_tilt_deg: 35\n",
     "", "1:1: controller is missing: expected a group of keys, to begin with {type: cascaded-pid}"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\n  rate_hz: 1000\n  delay_s: 0.1",
     "20:12: controller.delay_s is 0.1: expected at most 64 control ticks, 0.064 s; a controller.rate_hz of 640 or "
     "less would do"},
    // More than a state can remember: said once, also where a problem takes it over.
    {"max_tilt_deg: 35", "max_tilt_deg: 35\n  rate_hz: 1000\nuncertainty: {vehicle: {delay_s: {range: [0, 0.2]}}}",
     "20:34: uncertainty.vehicle.delay_s reaches from 0 to 0.2 s: expected 0 to 64 control ticks, 0.064 s; a "
     "controller.rate_hz of 320 or less would do, or a narrower {range: [low, high]} of delays"},
    {"max_tilt_deg: 35", "max_tilt_deg: 35\nuncertainty: {vehicle: {rotor_time_constant_s: {sd: 0.01}}}",
     "19:48: uncertainty.vehicle.rotor_time_constant_s is uncertain for rotors without a lag: give the robot its "
     "rotors.time_constant_s first"},
};

}  // namespace

TEST_CASE("a malformed robot is an error in its own file") {
    check(edits, "robot.yaml", [](auto from, auto to) { return errors_after_robot(TestFolder(), from, to); });
    // Errors of a robot inline stand in the problem's file.
    const TestFolder folder;
    std::string indented = "robot:";
    for (const char c : "\n" + edited(good_robot, "mass_kg: 4.5", "mass_kg: -4.5")) {
        indented += c == '\n' ? std::string("\n  ") : std::string(1, c);
    }
    CHECK(errors_after(folder, "robot: robot.yaml", indented) ==
          "problem.yaml:7:14: robot.multirotor.mass_kg is -4.5: expected a number in kg from 0.0001 to 10000");
}

TEST_CASE("a robot file that is read alone names its errors without the problem's prefix") {
    const TestFolder folder;
    folder.write("robot.yaml", edited(good_robot, "mass_kg: 4.5", "mass: 4.5"));
    CHECK(folder.errors_in([&] { return read_robot(folder / "robot.yaml"); }) ==
          "robot.yaml:4:3: unknown key 'mass' in multirotor: its unit is missing; expected mass_kg");
}
