#include "downwash/cli/identify_command.hpp"

#include "downwash/cli/common_options.hpp"

namespace downwash::cli {

void add_identify(Command program, Action& action, ExitCode (*run)(const IdentifyArguments&)) {
    auto [command, given] =
        add_command(program, action, "identify",
                    "Learn from logs of flights what a robot in space is really like: mass, thrust, lag, delay, drag, "
                    "centre of mass, "
                    "biases and noise with their standard deviations, as the `uncertainty:` of its file",
                    run);
    command.add_option("ROBOT", given.robot, "the robot file that flew, in space").required().offers_files({".yaml"});
    command
        .add_option("LOG", given.logs,
                    "logs of flights of this robot, one file each: ULog, DataFlash, bag or CSV as of `compare`")
        .required()
        .offers_files({".csv", ".ulg", ".bin", ".bag"});
    add_out(command, "FILE", given.out, "the robot file with what was learned, .yaml").required();
    command
        .add_option("--held-back LOG", given.held_back,
                    "a flight to learn nothing from; it is compared with flights in worlds, before and after; may be "
                    "repeated")
        .repeated()
        .offers_files({".csv", ".ulg", ".bin", ".bag"});
    command.add_flag("--true-motion", given.is_true_motion,
                     "the logs have how the vehicle moved, as a trajectory.csv of ours, and not what it saw: they do "
                     "not tell delay and biases");
    command
        .add_option("--thrust-exponent P", given.thrust_exponent,
                    "of logs with shares of the full command: thrust is max_thrust_n times the share to the power P")
        .in_range(0.5, 3.0);
    command
        .add_option("--axes A", given.axes,
                    "axes of the log: ned (z down; body forward, right, down) or enu (z up; body forward, left, up); "
                    "default: those of its format")
        .one_of({"ned", "enu"});
    command
        .add_option("--column SIGNAL=NAME", given.columns,
                    "the column of a CSV that holds a quantity; as of `compare`, may be repeated")
        .repeated();
    command.add_option("--ground Z", given.ground_m, "height of a wide, level floor below the flights [m]");
    command.add_option("--ceiling Z", given.ceiling_m, "height of a wide, level ceiling above the flights [m]");
    command.add_option("--surface-data FILE", given.surface_data,
                       "the thrust ratio near that floor or ceiling by distance, .csv for `aeromap fit`");
    command
        .add_option("--wind-sd V", given.wind_sd_m_s,
                    "standard deviation of the steady wind along x and y before a log tells [m/s]; default 0.5")
        .in_range(0.0, 20.0);
    command.add_option("--gust V", given.gust_m_s, "standard deviation of gusts [m/s]; default 0.3")
        .in_range(0.0, 20.0);
    command.add_option("--held-back-worlds N", given.worlds, "worlds in which a flight held back is flown")
        .in_range<std::uint64_t>(10, 10000)
        .shows_default();
    command.add_option("--seed N", given.seed, "seed of the random numbers; of the worlds of --held-back")
        .shows_default();
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
