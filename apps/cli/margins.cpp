#include "downwash/simulation/loop_margins.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include "downwash/base/angles.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

/// What a robust loop should have at least (Astrom and Murray 2008, section 9.3).
constexpr double enough_gain_db = 6;
constexpr double enough_phase_rad = std::numbers::pi / 4;

struct ArmPose {
    const char* name;
    double arm_rad;
};
constexpr ArmPose poses[] = {{"up", -std::numbers::pi / 2}, {"level", 0}, {"down", std::numbers::pi / 2}};

struct MarginsArguments {
    std::string robot;
    bool as_json = false;
};

bool is_enough(const LoopMargins& margins) {
    return margins.gain_margin_db >= enough_gain_db && margins.phase_margin_rad >= enough_phase_rad;
}

std::string text_of(double value, const char* unit) {
    return std::isfinite(value) ? fmt::format("{:.1f} {}", value, unit) : "-";
}

ExitCode run(const MarginsArguments& given) {
    const Robot robot = read_robot(given.robot);
    auto rows = Json::array();
    if (!given.as_json) {
        fmt::print("{}: margins of the sampled loop at hover in free air, opened at one command at a time\n\n",
                   robot.name);
        fmt::print("{:<7}{:<15}{:>12}{:>14}{:>16}{:>14}\n", "arm", "loop", "gain margin", "phase margin", "crossover",
                   "delay margin");
    }
    for (const ArmPose& pose : poses) {
        if (robot.arm.is_limited &&
            (pose.arm_rad < robot.arm.lower_limit_rad || pose.arm_rad > robot.arm.upper_limit_rad)) {
            continue;
        }
        const auto all = loop_margins(robot, pose.arm_rad);
        for (const LoopInput input : all_loop_inputs) {
            const LoopMargins& margins = all[static_cast<std::size_t>(input)];
            rows.push_back({{"arm", pose.name},
                            {"loop", name_of(input)},
                            {"gain_margin_db", finite(margins.gain_margin_db)},
                            {"phase_margin_deg", finite(margins.phase_margin_rad * degrees_per_radian)},
                            {"crossover_rad_s", finite(margins.crossover_rad_s)},
                            {"delay_margin_s", finite(margins.delay_margin_s)},
                            {"is_enough", is_enough(margins)}});
            if (!given.as_json) {
                fmt::print("{:<7}{:<15}{:>12}{:>14}{:>16}{:>14}{}\n", pose.name, name_of(input),
                           text_of(margins.gain_margin_db, "dB"),
                           text_of(margins.phase_margin_rad * degrees_per_radian, "deg"),
                           text_of(margins.crossover_rad_s, "rad/s"), text_of(1e3 * margins.delay_margin_s, "ms"),
                           is_enough(margins) ? "" : "  below 6 dB or 45 deg");
            }
        }
    }
    if (given.as_json) {
        print_json({{"robot", robot.name}, {"margins", std::move(rows)}});
    }
    return ExitCode::done;
}

}  // namespace

void add_margins(Command program, Action& action) {
    auto [command, given] =
        add_command(program, action, "margins",
                    "Print how far a robot's control loops are from instability: gain, phase and delay margins", run);
    command.add_option("ROBOT", given.robot, "robot file").placeholder("ROBOT").required();
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
