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
#include "downwash/simulation/robot_facts.hpp"

namespace downwash::cli {
namespace {

/// What a robust loop should have at least (Astrom and Murray 2008, section 9.3).
constexpr double enough_gain_db = 6;
constexpr double enough_phase_rad = std::numbers::pi / 4;

/// "up", "level", "down", or the angle.
std::string arm_name(double arm_rad) {
    const auto is = [arm_rad](double named_rad) { return std::abs(arm_rad - named_rad) < 1e-9; };
    constexpr double quarter_turn_rad = std::numbers::pi / 2;
    return is(-quarter_turn_rad)  ? "up"
           : is(0)                ? "level"
           : is(quarter_turn_rad) ? "down"
                                  : fmt::format("{:.0f} deg", arm_rad * degrees_per_radian);
}

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
                            {"is_enough", is_enough(margins)}});
            if (!given.as_json) {
                fmt::print("{:<7}{:<15}{:>12}{:>14}{:>16}{:>14}{}\n", arm, name_of(input),
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
