#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `validate` is asked for.
struct ValidateArguments {
    std::string problem;
    std::string plan;
    std::optional<std::uint64_t> runs, seed, world;
    std::optional<std::string> out;
    int threads = 1;
    bool as_json = false, is_quiet = false;
};

/// Adds `validate`. @param run what it does; null in a program that leaves it to downwash-validate
void add_validate(Command program, Action& action, ExitCode (*run)(const ValidateArguments&));

/// The command of downwash-validate.
ExitCode validate(const ValidateArguments& given);

/// The same for a problem in space.
ExitCode validate_in_space(const ValidateArguments& given);

/// @throws UsageError where options do not fit together or need an uncertainty that the problem has not got
void check_options(const ValidateArguments& given, bool has_uncertainty);

/// The command that flies one of the same worlds, up to its number.
[[nodiscard]] std::string command_for_one(const ValidateArguments& given);

}  // namespace downwash::cli
