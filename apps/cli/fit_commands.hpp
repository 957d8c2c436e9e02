#pragma once

#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"
#include "downwash/cli/measured_data.hpp"

namespace downwash::cli {

/// What `aeromap fit` is asked for.
struct FitArguments {
    MeasuredData data;
    std::string model;
    std::vector<std::string> fixed;
    bool of_tilt = false, of_walls = false, is_weighted = false, as_json = false;
    std::string picture;
};

/// What `aeromap compare` is asked for.
struct CompareArguments {
    std::vector<std::string> files;
    MeasuredData data;
    bool as_json = false, as_markdown = false;
};

/// Adds `aeromap`, without the commands below it.
Command add_aeromap_group(Command program);

// Each adds a command to `aeromap`. `run` is what it does; null in a program that leaves it to downwash-aeromap.
void add_aeromap_fit(Command aeromap, Action& action, ExitCode (*run)(const FitArguments&));
void add_aeromap_compare(Command aeromap, Action& action, ExitCode (*run)(const CompareArguments&));

// The commands of downwash-aeromap.
ExitCode fit_model(const FitArguments& given);
ExitCode compare_models(const CompareArguments& given);

}  // namespace downwash::cli
