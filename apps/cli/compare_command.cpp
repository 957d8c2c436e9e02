#include "downwash/cli/compare_command.hpp"

#include "downwash/cli/common_options.hpp"

namespace downwash::cli {

void add_compare(Command program, Action& action, ExitCode (*run)(const CompareLogArguments&)) {
    auto [command, given] =
        add_command(program, action, "compare",
                    "Compare a flight log with the plan that was flown: tracking by axis and phase, clearance as "
                    "flown, thrust, and "
                    "where the vehicle was outside of what the worlds of the plan's uncertainty allow",
                    run);
    given.threads = default_threads();
    command.add_option("PLAN", given.plan, "folder of a run, or its solution.json").required().offers_files({".json"});
    command
        .add_option("LOG", given.logs,
                    "flight log: ULog (PX4), DataFlash (ArduPilot, .bin), a ROS 1 bag or CSV; several CSV files of one "
                    "flight, such as ulog2csv writes")
        .required()
        .offers_files({".ulg", ".bin", ".bag", ".csv"});
    command
        .add_option("--problem-file FILE", given.problem,
                    "problem that the plan is of; default: effective.yaml beside the plan")
        .offers_files({".yaml"});
    Option format = command.add_option("--log-format F", given.format, "format of the log; default: as its bytes show");
    format.one_of({"ulog", "dataflash", "rosbag", "csv"});
    Option axes = command.add_option("--axes A", given.axes,
                                     "axes of the log: ned (z down; body forward, right, down) or enu (z up; body "
                                     "forward, left, up); default: those "
                                     "of its format, or those that fit the plan");
    axes.one_of({"ned", "enu"});
    Option unit = command.add_option("--time-unit U", given.time_unit,
                                     "unit of the times in a CSV; default: guessed from name and step");
    unit.one_of({"s", "ms", "us", "ns"});
    Option angles = command.add_option("--angles U", given.angles, "unit of the angles in a CSV; default: guessed");
    angles.one_of({"rad", "deg"});
    command
        .add_option("--column SIGNAL=NAME", given.columns,
                    "the column of a CSV that holds a quantity; quantities: t, x, y, z, vx, vy, vz, qw, qx, qy, qz, "
                    "roll, pitch, yaw, "
                    "joint_1, rotor_1, ...; may be repeated")
        .repeated();
    command
        .add_option("--topic TOPIC", given.topics,
                    "topic of a bag to be read; may be repeated; default: the first of each kind")
        .repeated();
    command.add_option("--time-offset S", given.time_offset_s,
                       "time since the log's beginning at which the plan begins; default: by correlation");
    command.add_flag("--in-world", given.is_in_world,
                     "take the log's places as those of the problem's world; default: turned about z and moved to fit");
    command.add_option("--envelope-worlds N", given.worlds,
                       "worlds of the problem's uncertainty that span the envelope; default 32, or 0 without an "
                       "uncertainty");
    command.add_flag("--allow-truncated", given.allows_truncation,
                     "read a log that ends within a message, up to there; default: such a log is an error");
    add_out(command, "DIR", given.out,
            "folder for comparison.json, what --json prints, and the page comparison.html; default: no files");
    add_threads(command, given.threads);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
