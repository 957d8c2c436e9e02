#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash {
struct LocatedError;
struct ShownRobot;
}  // namespace downwash

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

/// What `robot show` is asked for.
struct RobotShowArguments {
    std::string robot;
    std::optional<std::string> out;
    bool as_json = false;
};

/// What `robot thrust` is asked for.
struct RobotThrustArguments {
    std::vector<std::string> files;
    std::optional<std::string> out;
    std::optional<double> radius_m, hover_n;
    double air_density = 1.225;
    std::vector<std::string> columns, units;
    bool as_json = false;
};

/// Adds `robot`, without the commands below it.
Command add_robot_group(Command program);

/// Adds `robot import`. @param run what it does; null in a program that leaves it to downwash-robot
void add_robot_import(Command robot, Action& action, ExitCode (*run)(const RobotImportArguments&));

/// Adds `robot show`.
void add_robot_show(Command robot, Action& action, ExitCode (*run)(const RobotShowArguments&));

/// What `robot thrust` does.
ExitCode thrust_of_stand(const RobotThrustArguments& given);

/// Adds `robot thrust`.
void add_robot_thrust(Command robot, Action& action);

/// Shows a robot file. @throws LeftToPart for a URDF, SDF or MJCF
ExitCode show_robot_file(const RobotShowArguments& given);

/// Whether a file is one of another program: its first letter is that of XML. A file that cannot be read is not.
[[nodiscard]] bool is_model_file(const std::string& file);

/// Prints what there is to see of a robot, and writes its page. Warnings stand on the page, and as JSON; printing them
/// is the caller's.
ExitCode show(const ShownRobot& shown, const RobotShowArguments& given, const std::vector<LocatedError>& warnings);

// The commands of downwash-robot.
ExitCode import_robot_file(const RobotImportArguments& given);
ExitCode show_any_robot(const RobotShowArguments& given);

}  // namespace downwash::cli
