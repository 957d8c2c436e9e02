#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `identify` is asked for.
struct IdentifyArguments {
    std::string robot;
    std::vector<std::string> logs, held_back, columns;
    std::string out;
    std::optional<std::string> axes, surface_data;
    std::optional<double> ground_m, ceiling_m, thrust_exponent, wind_sd_m_s, gust_m_s;
    std::uint64_t worlds = 100, seed = 1;
    bool is_true_motion = false, as_json = false;
};

/// Adds `identify`. @param run what it does; null in a program that leaves it to downwash-identify
void add_identify(Command program, Action& action, ExitCode (*run)(const IdentifyArguments&));

/// The command of downwash-identify.
ExitCode identify_robot(const IdentifyArguments& given);

}  // namespace downwash::cli
