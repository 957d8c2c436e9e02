#include "downwash/cli/robot_commands.hpp"

#include "downwash/cli/common_options.hpp"

namespace downwash::cli {

Command add_robot_group(Command program) {
    Command robot = program.add_command(
        "robot", "Make robot files from those of other programs and of thrust stands, and show robots");
    robot.require_command();
    return robot;
}

void add_robot_import(Command robot, Action& action, ExitCode (*run)(const RobotImportArguments&)) {
    auto [command, given] = add_command(
        robot, action, "import",
        "Make a robot file in space from a URDF, SDF or MJCF: masses, inertias, shapes, the arm, and rotors from "
        "plug-ins of Gazebo or actuators, with gains designed for it",
        run);
    command.add_option("FILE", given.file, "the file to import").required().offers_files({".urdf", ".sdf", ".xml"});
    add_out(command, "FILE", given.out, "the robot file, .yaml").required();
    command.add_option("--name NAME", given.name, "name of the robot; default: that in the file");
    command
        .add_option("--freeze JOINT=DEG", given.frozen,
                    "hold a joint at an angle in degrees, or a sliding one at a place in m; may be repeated")
        .repeated();
    command.add_option("--arm LINK", given.arm_end, "the link at the end of the arm; other joints are held at zero");
    command.add_option("--tool LINK", given.tool,
                       "the link at whose origin the end effector is; default: the only link without mass at the end "
                       "of the arm, or the farthest end of its shapes");
    command
        .add_option("--massless LINK", given.massless,
                    "take a link to have no mass, though it has a shape; may be repeated")
        .repeated();
    command.add_flag("--skip-meshes", given.skips_meshes, "leave out meshes that are not there or no STL or OBJ");
    command.add_option("--forward AXIS", given.forward,
                       "axis of the base that points forward, such as y or -x; default x");
    command.add_option("--up AXIS", given.up, "axis of the base that points up; default z");
    command.add_option(
        "--rotors REGEX", given.rotors,
        "links that are rotors, by their names or those of their joints; default: those that plug-ins or "
        "actuators describe. What the file does not say of them is asked for");
    command.add_option("--rotor-radius-m M", given.rotor_radius_m, "radius of all rotors").positive();
    command.add_option("--max-thrust-n N", given.max_thrust_n, "greatest thrust of each rotor").positive();
    command.add_option("--min-thrust-n N", given.min_thrust_n, "least thrust of each rotor; default 0")
        .in_range(0.0, 1e5);
    command.add_option("--torque-ratio-m M", given.torque_ratio_m, "drag torque of a rotor over its thrust").positive();
    command.add_option("--rotor-lag-s S", given.rotor_lag_s, "time constant of thrust behind its command; 0 for none")
        .in_range(0.0, 10.0);
    command
        .add_option("--power-coefficient K", given.power_coefficient,
                    "power of a rotor over its thrust^1.5 [W/N^1.5]; default: momentum theory with a figure of "
                    "merit of 0.6")
        .positive();
    command
        .add_option("--spin S", given.spins,
                    "how each rotor turns, in the order of the file: 1 counterclockwise from above, -1 clockwise")
        .values(1, 64);
    add_json(command, given.as_json);
}

void add_robot_show(Command robot, Action& action, ExitCode (*run)(const RobotShowArguments&)) {
    auto [command, given] = add_command(robot, action, "show",
                                        "Show a robot: its masses, centres of mass, rotors with their spins and shares "
                                        "of thrust in a hover, and reach; "
                                        "with -o as a page in three dimensions",
                                        run);
    command.add_option("ROBOT", given.robot, "robot file, or a URDF, SDF or MJCF to import as `robot import` does")
        .required()
        .offers_files({".yaml", ".urdf", ".sdf", ".xml"});
    add_out(command, "FILE", given.out, "the page, .html");
    add_json(command, given.as_json);
}

void add_robot_thrust(Command robot, Action& action) {
    auto [command, given] = add_command(
        robot, action, "thrust",
        "Compute a rotor's keys of a robot file from tables and logs of a thrust stand: thrust limits, thrust "
        "coefficient, torque ratio, power coefficient, lag, and how much they scatter",
        thrust_of_stand);
    command
        .add_option(
            "DATA", given.files,
            "delimited text with a thrust, such as 'Thrust (gf)', and any of throttle, torque, speed, voltage, "
            "current, power and time, or with CT, CP and RPM; several files of one rotor, or of equal ones, are "
            "taken together")
        .required()
        .offers_files({".csv", ".tsv", ".txt"});
    add_out(command, "FILE", given.out, "the keys, .yaml, to be put into a robot file; default: standard output");
    command.add_option("--radius-m M", given.radius_m, "radius of the rotor, for C_T and for files with coefficients")
        .positive();
    command.add_option("--air-density RHO", given.air_density, "density of the air [kg/m3]")
        .in_range(0.1, 10.0)
        .shows_default();
    command
        .add_option("--hover-n N", given.hover_n,
                    "take the power coefficient near this thrust of one rotor; default: over all thrusts")
        .positive();
    command
        .add_option("--column QUANTITY=NAME", given.columns,
                    "the column of a CSV that holds a quantity; such as thrust=Schub; may be repeated")
        .repeated();
    command
        .add_option("--unit QUANTITY=UNIT", given.units, "the unit of a quantity, such as thrust=gf; may be repeated")
        .repeated();
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
