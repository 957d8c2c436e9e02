#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/planner/solution.hpp"

namespace downwash::cli {

/// What `replan` is asked for.
struct ReplanArguments {
    std::string problem;
    std::string plan;
    double at_s = 0;
    PlannerOptions planner;
    int threads = default_threads();
    std::optional<std::string> out;
    CommandLimits limits;
    bool stop_at_first = false, no_cache = false, is_quiet = false, as_json = false, force = false;
};

/// The file of the problem that the plan was made for: that of its run folder or, where it has none, the given one.
[[nodiscard]] std::string problem_of_plan(const ReplanArguments& given);

/// The tick of --after. @param end_s,tick_s of the plan that is left   @throws UsageError if it is none of the plan
[[nodiscard]] std::int64_t tick_at(const ReplanArguments& given, double end_s, double tick_s);

/// What progress begins with. @param name of the problem
[[nodiscard]] std::string takeover_announcement(const std::string& name, std::uint32_t seed, const Replanned& from);

/// `replan` in space.
[[nodiscard]] ExitCode replan_in_space(const ReplanArguments& given);

}  // namespace downwash::cli
