#include "downwash/planner/solve.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "downwash/planner/any_order.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/flight_search.hpp"
#include "downwash/planner/line_search.hpp"
#include "downwash/planner/search_clock.hpp"

namespace downwash {

namespace {

/// When to give up the flight of a plan that was not flown yet. A stop that came before leaves it a moment, which is
/// plenty in most scenes: whoever interrupts wants to know what the plan is worth.
StopCondition end_of_last_flight(const std::stop_token& stop) {
    constexpr double moment_s = 0.1;
    if (stop.stop_requested()) {
        return [since = planning::Stopwatch()] { return since.seconds() >= moment_s; };
    }
    return [stop] { return stop.stop_requested(); };
}

/// One search, by lines or flights. @param whole the problem that the part is of   @return as PartSearch
std::optional<std::size_t> search_part(const Problem& part, const Problem& whole, const FlightModel& model,
                                       const AeroMap* map, const planning::Course& before,
                                       const planning::PlanChecks& checks, const SolveOptions& options,
                                       Solution& into) {
    if (whole.planner.variant == Variant::mp_arm) {
        planning::search_lines(part, model, options, into);
        return std::nullopt;
    }
    return planning::search_flights(part, whole, model, map, before, checks, options, into);
}

/// One goal, or several in their order.
/// @param least_round see solve_in_turn()   @param attempts plans that asked for a certificate so far
void plan_goals(const Problem& problem, const std::shared_ptr<const FlightModel>& model,
                const std::shared_ptr<const AeroMap>& map, const SolveOptions& options, double least_round,
                std::uint64_t& attempts, Solution& solution) {
    std::optional<planning::ProblemWorlds> worlds;
    if (problem.uncertainty && problem.planner.variant == Variant::mp_arm_ada) {
        const planning::Stopwatch clock;
        worlds.emplace(problem, model, map, options);
        solution.planning.map_wall_s += clock.seconds();
    }
    std::optional<planning::StopFinder> stops;
    if (options.finds_stops && problem.planner.variant == Variant::mp_arm_ada) {
        stops.emplace(problem, model, map,
                      problem.uncertainty ? planning::search_worlds(problem) : std::vector<FlownWorld>(),
                      options.threads);
    }
    const planning::PlanChecks checks{worlds ? &*worlds : nullptr, stops ? &*stops : nullptr};
    const auto search = [&](const Problem& part, const SolveOptions& how, const planning::Course& before,
                            Solution& into) {
        return search_part(part, problem, *model, map.get(), before, checks, how, into);
    };
    if (!problem.stops.empty()) {
        planning::solve_in_turn(problem, *model, map.get(), options, search, least_round, attempts, solution);
        return;
    }
    planning::Course start = planning::Course::from_start(problem, *model);
    start.attempts = attempts;
    static_cast<void>(search(problem, options, start, solution));
    attempts = solution.certificate ? solution.certificate->attempts : attempts;
    if (stops && solution.status == Status::solved && !solution.stops) {  // found when the time was up
        solution.stops = stops->along(*solution.plan, end_of_last_flight(options.stop));
    }
}

/// @param since_call counts from the caller's call on, checks included
/// @throws WorkStopped when a stop is requested in the middle of anything; the solution has what there is
void plan_and_fly(const PlannableProblem& plannable, const SolveOptions& options, const planning::Stopwatch& since_call,
                  Solution& solution) {
    const Problem& problem = plannable.problem;
    const auto& model = plannable.model;
    const StopCondition is_stopped = [&options] { return options.stop.stop_requested(); };
    std::shared_ptr<const AeroMap> map;
    if (problem.planner.variant == Variant::mp_arm_ada && problem.aero.enabled) {
        const planning::Stopwatch clock;
        if (options.map && !model->is_mine(*options.map, problem.bounds)) {
            throw std::invalid_argument(
                "SolveOptions::map is of another scene, robot, model or bounds: expected a map of the same problem, or "
                "none");
        }
        map = options.map ? options.map
                          : model->make_map(problem.bounds, options.threads, options.on_map_progress, options.map_cache,
                                            is_stopped);
        solution.planning.map_wall_s = clock.seconds();
        solution.map = map;
    }
    const bool plans_in_worlds = problem.uncertainty && problem.planner.variant == Variant::mp_arm_ada;
    solution.planning.setup_wall_s = since_call.seconds();
    if (problem.targets.empty()) {
        std::uint64_t attempts = 0;
        plan_goals(problem, model, map, options, 0, attempts, solution);
    } else {
        planning::solve_in_any_order(
            problem, *model, map.get(), options,
            [&](const Problem& leg, const SolveOptions& how, const planning::Course& before, Solution& into) {
                static_cast<void>(search_part(leg, leg, *model, map.get(), before, {}, how, into));
            },
            [&](const Problem& in_order, const SolveOptions& how, double least_round, std::uint64_t& attempts,
                Solution& into) { plan_goals(in_order, model, map, how, least_round, attempts, into); },
            solution);
    }
    const Problem flown = in_order(problem, solution.order);
    if (solution.plan && !(solution.execution && solution.status == Status::solved)) {
        solution.execution = planning::execute_directly(
            *model, start_state(*model, problem.start), *solution.plan, goals_of(flown), flown.energy_budget_j,
            solution.planning.flight_wall_s, end_of_last_flight(options.stop));
    }
    if (problem.uncertainty && !plans_in_worlds && solution.status == Status::solved) {
        // The others know nothing of worlds: what becomes of their plan is for comparison.
        const auto flown_map = problem.aero.enabled
                                   ? model->make_map(problem.bounds, options.threads, {}, options.map_cache, is_stopped)
                                   : nullptr;
        planning::ProblemWorlds fresh(flown, model, flown_map, options);
        solution.certificate = fresh.certify(*solution.plan, 1, is_stopped);
    }
}

Solution solve_checked(const PlannableProblem& plannable, const SolveOptions& asked,
                       const planning::Stopwatch& since_call) {
    const PlannerSettings& settings = plannable.problem.planner;
    SolveOptions options = asked;
    options.threads = std::max(1, options.threads);
    Solution solution;
    solution.variant = settings.variant;
    solution.algorithm = settings.algorithm;
    solution.objective = settings.objective;
    solution.seed = settings.seed;
    solution.threads = options.threads;
    try {
        plan_and_fly(plannable, options, since_call, solution);
    } catch (const WorkStopped&) {  // there is what was found before
    }
    solution.interrupted = options.stop.stop_requested();
    if (solution.execution) {
        solution.execution_cost = cost_of(*solution.execution, solution.objective);
    }
    return solution;
}

}  // namespace

Solution solve(const PlannableProblem& plannable, const SolveOptions& options) {
    return solve_checked(plannable, options, planning::Stopwatch());
}

Solution solve(const Problem& problem, const SolveOptions& options) {
    const planning::Stopwatch since_call;
    return solve_checked(plannable(problem), options, since_call);
}

}  // namespace downwash
