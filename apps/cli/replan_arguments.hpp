#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/space_solution_file.hpp"

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

/// The moment of the plan from which the new one takes over. @param flown what the plan was made for
template <class AnyProblem>
[[nodiscard]] auto takeover_of(const ReplanArguments& given, const AnyProblem& flown) {
    const auto earlier = read_solution(plan_file(given.plan), flown);
    const auto& plan = *earlier.plan;
    return take_over(flown, plan, earlier.order, tick_at(given, plan.duration_s(), plan.tick_s));
}

/// Makes of a problem what is left of it, with the settings that were given. @param from outlives what is returned
template <class Taken>
[[nodiscard]] auto leaving_rest(const ReplanArguments& given, const Taken& from) {
    return [&given, &from](auto& settings) {
        given.planner.apply_to(settings);
        settings = remaining(from, std::move(settings));
    };
}

/// What solution.json says of the takeover. @param outcome,cost how the rest of the plan flies in the problem as it is
/// now
template <class Taken>
[[nodiscard]] Replanned replanned_from(const ReplanArguments& given, const Taken& from, Outcome outcome, double cost) {
    return {given.plan, from.tick, static_cast<double>(from.tick) * from.rest.tick_s, outcome, cost, {}};
}

/// What progress begins with. @param name of the problem
[[nodiscard]] std::string takeover_announcement(const std::string& name, std::uint32_t seed, const Replanned& from);

/// `replan` in space.
[[nodiscard]] ExitCode replan_in_space(const ReplanArguments& given);

}  // namespace downwash::cli
