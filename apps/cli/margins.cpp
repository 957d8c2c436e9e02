#include "downwash/cli/margins.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/robot_facts.hpp"

namespace downwash::cli {
namespace {

struct MarginsArguments {
    std::string robot;
    std::vector<double> joints_deg;
    bool designs = false;
    Design design;
    bool as_json = false;
};

std::string text_of_margin(double value, const char* unit) {
    return std::isfinite(value) ? fmt::format("{:.1f} {}", value, unit) : "-";
}

ExitCode run(const MarginsArguments& given) {
    if (given.designs) {
        Design design = given.design;
        design.robot = given.robot;
        design.as_json = given.as_json;
        return design_gains(design);
    }
    if (!(given.design.bandwidths == SpaceBandwidths{}) || given.design.law) {
        throw UsageError("bandwidths and --law are for --design: expected it, too");
    }
    if (is_space_robot_file(given.robot)) {
        return margins_in_space(given.robot, given.joints_deg, given.as_json);
    }
    if (!given.joints_deg.empty()) {
        throw UsageError("--joints-deg is for robots in space: {} is one in a vertical plane", given.robot);
    }
    const Robot robot = read_robot(given.robot);
    auto rows = Json::array();
    if (!given.as_json) {
        fmt::print("{}: margins of the sampled loop at hover in free air, opened at one command at a time\n\n",
                   robot.name);
        fmt::print("{:<7}{:<15}{:>12}{:>14}{:>16}{:>14}\n", "arm", "loop", "gain margin", "phase margin", "crossover",
                   "delay margin");
    }
    for (const double arm_rad : examined_arm_angles_rad(robot.arm)) {
        const std::string arm = arm_name(arm_rad);
        const auto all = loop_margins(robot, arm_rad);
        for (const LoopInput input : all_loop_inputs) {
            const LoopMargins& margins = all[static_cast<std::size_t>(input)];
            rows.push_back({{"arm", arm},
                            {"loop", name_of(input)},
                            {"gain_margin_db", finite(margins.gain_margin_db)},
                            {"phase_margin_deg", finite(margins.phase_margin_rad * degrees_per_radian)},
                            {"crossover_rad_s", finite(margins.crossover_rad_s)},
                            {"delay_margin_s", finite(margins.delay_margin_s)},
                            {"is_enough", has_enough(margins)}});
            if (!given.as_json) {
                fmt::print("{:<7}{:<15}{:>12}{:>14}{:>16}{:>14}{}\n", arm, name_of(input),
                           text_of_margin(margins.gain_margin_db, "dB"),
                           text_of_margin(margins.phase_margin_rad * degrees_per_radian, "deg"),
                           text_of_margin(margins.crossover_rad_s, "rad/s"),
                           text_of_margin(1e3 * margins.delay_margin_s, "ms"),
                           has_enough(margins) ? "" : "  below 6 dB or 45 deg");
            }
        }
    }
    if (given.as_json) {
        print_json({{"robot", robot.name}, {"margins", std::move(rows)}});
    }
    return ExitCode::done;
}

}  // namespace

bool has_enough(const LoopMargins& margins) {
    constexpr double enough_gain_db = 6;
    constexpr double enough_phase_rad = std::numbers::pi / 4;
    return margins.gain_margin_db >= enough_gain_db && margins.phase_margin_rad >= enough_phase_rad;
}

std::string arm_name(double arm_rad) {
    const auto is = [arm_rad](double named_rad) { return std::abs(arm_rad - named_rad) < 1e-9; };
    constexpr double quarter_turn_rad = std::numbers::pi / 2;
    return is(-quarter_turn_rad)  ? "up"
           : is(0)                ? "level"
           : is(quarter_turn_rad) ? "down"
                                  : fmt::format("{:.0f} deg", arm_rad * degrees_per_radian);
}

void add_margins(Command program, Action& action) {
    auto [command, given] = add_command<MarginsArguments>(
        program, action, "margins",
        "Print how far a robot's control loops are from instability: gain, phase and delay margins", run);
    command.add_option("ROBOT", given.robot, "robot file").placeholder("ROBOT").required();
    command
        .add_option("--joints-deg Q", given.joints_deg, "angles of all joints of a robot in space; default: some poses")
        .values(1, max_joints);
    command.add_flag(
        "--design", given.designs,
        "print the controller section with gains for the bandwidths below, of a robot with or without one");
    command.add_option("--law NAME", given.design.law, "law of that section; default: the robot's, or model-inversion")
        .one_of({std::string(SpaceInversion::name), std::string(Px4Cascade::name)});
    SpaceBandwidths& bandwidths = given.design.bandwidths;
    const auto add_bandwidth = [&command = command](const std::string& spelling, auto& value, const std::string& what) {
        return command.add_option(spelling, value, "natural frequency of " + what).in_range(0.01, 1000.0);
    };
    add_bandwidth("--translation-rad-s W", bandwidths.translation_rad_s, "x and y").shows_default();
    add_bandwidth("--height-rad-s W", bandwidths.height_rad_s, "the height").shows_default();
    add_bandwidth("--attitude-rad-s W", bandwidths.attitude_rad_s,
                  "the tilt; default: 0.35 / lag of the rotors and, in space, of the controller, at most 12");
    add_bandwidth("--yaw-rad-s W", bandwidths.yaw_rad_s, "the yaw").shows_default();
    add_bandwidth("--joints-rad-s W", bandwidths.joint_rad_s,
                  "the joints; default: 4.7 or, of a model inversion in space, more if the arm's weight asks for it");
    command
        .add_option("--observer-1-s L", bandwidths.observer_gain_1_s,
                    "gain of the disturbance observer; 0: none; default: 3 or, in space, from half of the joints' "
                    "frequency, more if their margins ask for it")
        .in_range(0.0, 1000.0);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
