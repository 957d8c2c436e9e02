#pragma once

#include <string>
#include <string_view>

#include "../support/test_files.hpp"
#include "downwash/problems/space_problem_reader.hpp"

namespace downwash::test {

inline constexpr std::string_view good_space_problem = R"(schema: downwash/problem/v1
name: test
robot: robot.yaml
environment:
  bounds: {x_m: [-6, 6], y_m: [-5, 5], z_m: [0.5, 5]}
  obstacles:
    - {name: ground, box: {size_m: [30, 20, 1], center_m: [0, 0, -0.5]}}
    - {name: pole, cylinder: {radius_m: 0.2, length_m: 5, center_m: [4, 3, 2.5]}}
start: {x_m: -4, y_m: 1, z_m: 2, yaw_deg: 30, joints_deg: [20, -10]}
goal:
  end_effector: {position_m: [3, -2, 2.5], tolerance_m: 0.1, direction: [0, 0, 1]}
  hold_s: 5
motion: {max_speed_m_s: 2}
)";

inline constexpr std::string_view good_space_robot = R"(schema: downwash/robot/v1
name: tester
multirotor:
  mass_kg: 2
  inertia_kg_m2: [0.02, 0.03, 0.04]
  body:
    - box: {size_m: [0.6, 0.6, 0.1], center_m: [0, 0, 0]}
rotors:
  radius_m: 0.12
  positions_m: [[0.2, 0.2, 0], [-0.2, 0.2, 0], [-0.2, -0.2, 0], [0.2, -0.2, 0]]
  spin: [1, -1, 1, -1]
  torque_ratio_m: 0.02
  max_thrust_n: 12
  power_coefficient_w_n1p5: 5
arm:
  links:
    - {joint_m: [0, 0, -0.05], axis: [0, 1, 0], mass_kg: 0.2, center_of_mass_m: [0.1, 0, 0],
       inertia_kg_m2: [0.0001, 0.001, 0.001], limits_deg: [-120, 120], max_torque_nm: 2}
    - {joint_m: [0.2, 0, 0], axis: [0, 0, 1], mass_kg: 0.1, center_of_mass_m: [0.15, 0, 0],
       inertia_kg_m2: [[0.0001, 0, 0], [0, 0.001, 0.00005], [0, 0.00005, 0.001]], limits_deg: [-90, 90], max_torque_nm: 1,
       body: [capsule: {radius_m: 0.02, to_m: [0.3, 0, 0]}]}
  end_effector_m: [0.3, 0, 0]
controller:
  position: {kp: 2, kd: 2.4}
  height: {kp: 12, kd: 7}
  joints: {kp: 22, kd: 9.5}
  attitude: {kp: 3, rate_kp: 14, yaw_kp: 1.2, yaw_rate_kp: 5}
)";

/// What reading a problem in space beside a robot ends with: see TestFolder::errors_in().
inline std::string space_errors(const TestFolder& folder, std::string_view problem, std::string_view robot) {
    folder.write("problem.yaml", problem);
    folder.write("robot.yaml", robot);
    return folder.errors_in([&] { return read_space_problem(folder / "problem.yaml"); });
}

/// The sound problem in space.
inline SpaceProblem read_good_space_problem(const TestFolder& folder) {
    folder.write("problem.yaml", good_space_problem);
    folder.write("robot.yaml", good_space_robot);
    return read_space_problem(folder / "problem.yaml");
}

}  // namespace downwash::test
