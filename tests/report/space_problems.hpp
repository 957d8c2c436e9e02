#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "../support/space_robots.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/results/number_table.hpp"

// Problems in space and flights for their pages and pictures.

namespace downwash::test {

/// A pier and a girder, a goal with a direction, and a robot with two joints that starts turned by 30 degrees.
inline SpaceProblem bay_problem() {
    SpaceProblem problem;
    problem.name = "bay";
    problem.robot = space_robot(2);
    problem.robot.body = {SpaceBodyShape{Box{{0.4, 0.3, 0.1}}, {}}};
    problem.robot.links[0].is_limited = true;
    problem.robot.links[0].lower_limit_rad = -1;
    problem.robot.links[0].upper_limit_rad = 1.5;
    problem.robot.links[1].body = {SpaceBodyShape{Capsule{0.02, {0, 0, 0}, {0.03, 0, -0.12}}, {}}};
    problem.bounds = {{-5, -4, 0.5}, {5, 4, 5}};
    problem.obstacles = {{"pier", Cylinder{0.5, 6, {0, 0, 1}}, {3, 1.5, 3}, {}},
                         {"girder", Box{{8, 0.4, 1.2}}, {0, 1.5, 4.2}, {}}};
    problem.start.position_m = {-3, -2, 1.5};
    problem.start.yaw_rad = 0.5235987755982988;
    SpaceEndEffectorGoal goal;
    goal.position_m = {1, 0.9, 3};
    goal.direction = Vector3{0, 0, -2};
    problem.goals = {SpaceGoal{goal}};
    return problem;
}

/// Some rows with the columns of trajectory.csv in space for a robot with two joints and six rotors.
inline NumberTable invented_rows(std::size_t rows) {
    NumberTable table;
    for (const char* name : {"t_s",
                             "ref_x_m",
                             "ref_y_m",
                             "ref_z_m",
                             "ref_yaw_rad",
                             "ref_joint_1_rad",
                             "ref_joint_2_rad",
                             "x_m",
                             "y_m",
                             "z_m",
                             "qw",
                             "qx",
                             "qy",
                             "qz",
                             "joint_1_rad",
                             "joint_2_rad",
                             "vx_m_s",
                             "vy_m_s",
                             "vz_m_s",
                             "wx_rad_s",
                             "wy_rad_s",
                             "wz_rad_s",
                             "joint_1_rate_rad_s",
                             "joint_2_rate_rad_s",
                             "joint_1_torque_nm",
                             "joint_2_torque_nm",
                             "aero_factor_min",
                             "aero_factor_max",
                             "clearance_m",
                             "ee_x_m",
                             "ee_y_m",
                             "ee_z_m",
                             "power_w",
                             "energy_j"}) {
        table.names.emplace_back(name);
    }
    for (int rotor = 1; rotor <= 6; ++rotor) {
        table.names.push_back("rotor_" + std::to_string(rotor) + "_cmd_n");
        table.names.push_back("rotor_" + std::to_string(rotor) + "_aero_factor");
    }
    for (std::size_t column = 0; column < table.names.size(); ++column) {
        std::vector<double>& values = table.columns.emplace_back();
        for (std::size_t row = 0; row < rows; ++row) {
            values.push_back(std::sin(0.1 * static_cast<double>(row) + static_cast<double>(column)));
        }
    }
    return table;
}

}  // namespace downwash::test
