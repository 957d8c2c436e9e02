#include "downwash/planner/goals_in_order.hpp"

#include <optional>
#include <utility>

#include "downwash/planner/braking.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/planner/worlds.hpp"

namespace downwash::planning {
namespace {

/// The search for the way through several goals.
SearchResult search_in_turn(const Problem& problem, const PlannerModel& model, PlanChecks checks,
                            const SolveOptions& options, const SequenceEffort& effort, std::uint64_t attempts) {
    GoalSequence sequence(problem, model, options, effort, attempts);
    while (const std::optional<GoalSequence::Part> part = sequence.next()) {
        checks.time_s = part->check_time_s;
        sequence.add(search_goal(part->problem, problem, model, *part->before, checks, part->options));
    }
    return std::move(sequence).result();
}

/// The search for the way to one goal.
SearchResult search_alone(const Problem& problem, const PlannerModel& model, const PlanChecks& checks,
                          const SolveOptions& options, std::uint64_t attempts) {
    Course start = Course::from_start(problem, *model.flight);
    start.attempts = attempts;
    SearchResult result = search_goal(problem, problem, model, start, checks, options);
    Found& found = result.found;
    if (checks.stop_finder != nullptr && found.status == Status::solved && !found.safe_stops) {  // the time was up
        try {
            found.safe_stops = checks.stop_finder->along(*found.plan, end_of_last_flight(options.stop));
        } catch (const WorkStopped&) {  // then nobody knows
        }
    }
    return result;
}

}  // namespace

SearchResult search_in_order(const Problem& problem, const PlannerModel& model, const SolveOptions& options,
                             const SequenceEffort& effort, std::uint64_t attempts) {
    std::optional<ProblemWorlds> worlds;
    if (problem.uncertainty) {
        worlds.emplace(problem, model, options);
    }
    std::optional<StopFinder> stop_finder;
    if (options.finds_stops) {
        stop_finder.emplace(problem, model.flight, model.true_map,
                            problem.uncertainty ? search_worlds(problem) : std::vector<FlownWorld>(), options.threads);
    }
    const PlanChecks checks{worlds ? &*worlds : nullptr, stop_finder ? &*stop_finder : nullptr};
    return problem.goals_before.empty() ? search_alone(problem, model, checks, options, attempts)
                                        : search_in_turn(problem, model, checks, options, effort, attempts);
}

StopCondition end_of_last_flight(const std::stop_token& stop) {
    constexpr double moment_s = 0.1;
    if (stop.stop_requested()) {
        return [since = Stopwatch()] { return since.seconds() >= moment_s; };
    }
    return [stop] { return stop.stop_requested(); };
}

}  // namespace downwash::planning
