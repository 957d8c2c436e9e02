#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "downwash/cli/command_line.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/planner/solution.hpp"

namespace downwash::cli {

/// What `execute` is asked for.
struct ExecuteArguments {
    std::string problem;
    std::string plan;
    std::string aero = "on";
    std::optional<std::uint64_t> world, seed;
    std::optional<std::string> out;
    PlannerOptions planner;
    int threads = default_threads();
    bool is_quiet = false, as_json = false, force = false;
};

/// The world that --world and --seed ask for; nothing for the nominal one.
/// @param seed of the plan   @throws UsageError if the problem has no uncertainty, or the options do not fit
[[nodiscard]] std::optional<ExecutionWorld> execution_world(const ExecuteArguments& given, bool has_uncertainty,
                                                            std::uint32_t seed);

/// `execute` for a problem in space.
ExitCode execute_in_space(const ExecuteArguments& given);

}  // namespace downwash::cli
