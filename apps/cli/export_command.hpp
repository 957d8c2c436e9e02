#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What `export --end` offers, in the order of MissionEnd.
inline constexpr std::array<std::string_view, 3> mission_ends{"hover", "land", "return"};

/// What `export` is asked for.
struct ExportArguments {
    std::string folder;
    std::string format;
    std::optional<std::string> out;
    std::optional<double> rate_hz;
    std::vector<double> origin;
    std::optional<double> bearing_deg;
    std::string end = "hover";
    bool anyway = false;               ///< write it even if the run's own flight failed
    std::optional<std::string> check;  ///< a file to compare with the plan, instead of writing one
    bool as_json = false;
};

/// Adds `export`. @param run what it does; null if the program hands the command to downwash-export
void add_export(Command program, Action& action, ExitCode (*run)(const ExportArguments&));

/// The command of downwash-export.
ExitCode export_run(const ExportArguments& given);

/// The same with --check.
ExitCode check_exported(const ExportArguments& given);

}  // namespace downwash::cli
