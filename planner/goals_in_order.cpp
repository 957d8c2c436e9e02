#include "downwash/planner/goals_in_order.hpp"

#include <optional>
#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/stop_finder.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/planner/worlds.hpp"

namespace downwash::planning {
namespace {

/// The search for the way through several goals.
template <class Family>
SearchResultOf<Family> search_in_turn(const typename Family::Problem& problem, const PlannerModelOf<Family>& model,
                                      PlanChecksOf<Family> checks, const SolveOptionsOf<Family>& options,
                                      const SequenceEffortOf<Family>& effort, std::uint64_t attempts) {
    GoalSequenceOf<Family> sequence(problem, model, options, effort, attempts);
    while (const auto part = sequence.next()) {
        checks.time_s = part->check_time_s;
        sequence.add(search_goal(part->problem, problem, model, *part->before, checks, part->options));
    }
    return std::move(sequence).result();
}

/// The search for the way to one goal.
template <class Family>
SearchResultOf<Family> search_alone(const typename Family::Problem& problem, const PlannerModelOf<Family>& model,
                                    const PlanChecksOf<Family>& checks, const SolveOptionsOf<Family>& options,
                                    std::uint64_t attempts) {
    CourseOf<Family> start = CourseOf<Family>::from_start(problem, *model.flight);
    start.attempts = attempts;
    SearchResultOf<Family> result = search_goal(problem, problem, model, start, checks, options);
    FoundOf<Family>& found = result.found;
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

SearchResultOf<Space> search_in_order(const SpaceProblem& problem, const PlannerModelOf<Space>& model,
                                      const SolveOptionsOf<Space>& options, const SequenceEffortOf<Space>& effort,
                                      std::uint64_t attempts) {
    std::optional<SpaceProblemWorlds> worlds;
    if (problem.uncertainty) {
        worlds.emplace(problem, model, options.threads);
    }
    std::optional<StopFinderOf<Space>> stop_finder;
    if (options.finds_stops) {
        stop_finder.emplace(problem, model.flight, model.true_map,
                            problem.uncertainty ? search_worlds(problem) : std::vector<SpaceWorld>(), options.threads);
    }
    const PlanChecksOf<Space> checks{worlds ? &*worlds : nullptr, stop_finder ? &*stop_finder : nullptr};
    return problem.goals.size() == 1 ? search_alone(problem, model, checks, options, attempts)
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
