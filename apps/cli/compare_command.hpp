#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `compare` is asked for.
struct CompareLogArguments {
    std::string plan;
    std::vector<std::string> logs;
    std::optional<std::string> problem, out, format, axes, time_unit, angles;
    std::vector<std::string> columns, topics;
    std::optional<double> time_offset_s;
    std::optional<std::uint64_t> worlds;
    int threads = 1;
    bool is_in_world = false, allows_truncation = false;
    bool as_json = false, is_quiet = false;
};

/// Adds `compare`. @param run what it does; null in a program that leaves it to downwash-compare
void add_compare(Command program, Action& action, ExitCode (*run)(const CompareLogArguments&));

/// The command of downwash-compare.
ExitCode compare_with_log(const CompareLogArguments& given);

}  // namespace downwash::cli
