#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `robot import` is asked for.
struct RobotImportArguments {
    std::string file;
    std::string out;
    std::optional<std::string> name, arm_end, tool, rotors, forward, up;
    std::vector<std::string> frozen, massless;
    bool skips_meshes = false;
    std::optional<double> rotor_radius_m, min_thrust_n, max_thrust_n, torque_ratio_m, rotor_lag_s, power_coefficient;
    std::vector<double> spins;
    bool as_json = false;
};

/// Adds `robot`, without the commands below it.
Command add_robot_group(Command program);

/// Adds `robot import`. @param run what it does; null in a program that leaves it to downwash-robot
void add_robot_import(Command robot, Action& action, ExitCode (*run)(const RobotImportArguments&));

/// The command of downwash-robot.
ExitCode import_robot_file(const RobotImportArguments& given);

}  // namespace downwash::cli
