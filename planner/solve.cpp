#include "downwash/planner/solve.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/planner/any_order.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/goals_in_order.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/problems/cut_off_goals.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash {

namespace {

/// The map of surface effects, through which MP-ARM-ADA plans and the certificates and stops of every variant are
/// flown; nullptr where none is needed.
std::shared_ptr<const AeroMap> map_for(const Problem& problem, const FlightModel& model, const SolveOptions& options) {
    if (!needs_map(problem, options.finds_stops)) {
        return nullptr;
    }
    if (options.map && !model.matches(*options.map, problem.bounds)) {
        throw std::invalid_argument(
            "SolveOptions::map is of another scene, robot, model or bounds: expected a map of the same problem, or "
            "none");
    }
    return options.map ? options.map : model.make_map(problem.bounds, options.map_cache);
}

planning::DirectFlight flown(const Problem& problem, const FlightModel& model, const Plan& plan,
                             const SolveOptions& options) {
    return planning::fly_directly(model, start_state(model, problem.start), plan, goals_of(problem),
                                  problem.energy_budget_j, planning::end_of_last_flight(options.stop));
}

/// A plan whose direct flight the end of the search cut off counts, if that flight is good after all and nothing else
/// was asked of it.
void count_if_good(const Problem& problem, Solution& solution) {
    const bool was_cut_off = solution.obstruction && solution.obstruction->cause == unfinished_flight;
    const bool is_certified = problem.uncertainty && problem.planner.certify;
    const bool is_whole =
        !solution.order || std::ranges::none_of(solution.order->left_out, [](const LeftOutTarget& each) {
            return each.reason == LeftOutReason::no_flight;
        });
    if (!was_cut_off || is_certified || !is_whole ||
        !planning::is_good(*solution.execution, problem.planner.safety_margin_m)) {
        return;
    }
    solution.status = Status::solved;
    solution.obstruction.reset();
    solution.missed_goal.reset();
    solution.nearest_approach_m.reset();
    SearchRecord& record = solution.planning;
    record.improvements.push_back(
        {record.wall_s, record.iterations, solution.cost, cost_of(*solution.execution, problem.planner.objective)});
}

/// What is told of a problem with goals to which no way leads in the plane; nothing if there may be a plan.
std::optional<planning::SearchResult> closed_plane(const Problem& problem, const FlightModel& model) {
    const planning::Stopwatch clock;
    const std::vector<CutOffGoal> cut_off = cut_off_goals(problem, model.scene());
    if (!leave_no_plan(cut_off, problem)) {
        return std::nullopt;
    }
    const CutOffGoal& first = cut_off.front();
    std::vector<std::string> labels;
    for (const std::size_t obstacle : first.obstacles) {
        labels.push_back(label_of(problem.obstacles, obstacle));
    }
    planning::SearchResult result;
    Found& found = result.found;
    Problem towards_goal = problem;
    towards_goal.goal = goals_of(problem)[first.goal];
    const double away_m = planning::SearchSpace(towards_goal, model).goal_distance_m(problem.start.at);
    found.obstruction = Obstruction{"closed_plane", problem.start.at, away_m, std::move(labels)};
    if (!problem.targets.empty()) {
        found.order.emplace();
        for (std::size_t target = 0; target < problem.targets.size(); ++target) {
            found.order->left_out.push_back({target, LeftOutReason::no_flight, std::nullopt});
        }
    } else if (!problem.goals_before.empty()) {
        found.missed_goal = first.goal + 1;
    }
    result.record.rejected = planning::no_rejections();
    result.record.wall_s = clock.seconds();
    return result;
}

/// A solution that says how it was asked for, and nothing yet.
Solution blank_solution(const PlannerSettings& settings, int threads) {
    Solution solution;
    solution.variant = settings.variant;
    solution.algorithm = settings.algorithm;
    solution.objective = settings.objective;
    solution.seed = settings.seed;
    solution.threads = threads;
    return solution;
}

/// @param since_call counts from the caller's call on, checks included
Solution solve_checked(const PlannableProblem& plannable, const SolveOptions& asked,
                       const planning::Stopwatch& since_call) {
    const Problem& problem = plannable.problem;
    SolveOptions options = asked;
    options.threads = std::max(1, options.threads);
    Solution solution = blank_solution(problem.planner, options.threads);
    try {
        const planning::Stopwatch map_clock;
        solution.map = map_for(problem, *plannable.model, options);
        const double reading_wall_s = solution.map ? map_clock.seconds() : 0;
        const double filling_before_s = solution.map ? solution.map->filling_s() : 0;
        const double setup_wall_s = since_call.seconds();
        const planning::PlannerModel own(problem.planner.variant, plannable.model, solution.map);
        // A vehicle in the air that asks anew has a plan, and no time.
        std::optional<planning::SearchResult> closed =
            options.known_plan ? std::nullopt : closed_plane(problem, *plannable.model);
        planning::SearchResult result = closed ? std::move(*closed)
                                        : problem.targets.empty()
                                            ? planning::search_in_order(problem, own, options)
                                            : planning::search_in_any_order(problem, own, options);
        static_cast<Found&>(solution) = std::move(result.found);
        solution.planning = std::move(result.record);
        solution.planning.setup_wall_s = setup_wall_s;

        const Problem visited = in_order(problem, solution.order);
        if (solution.plan && !(solution.execution && solution.status == Status::solved)) {
            planning::DirectFlight flight = flown(visited, *plannable.model, *solution.plan, options);
            solution.execution = std::move(flight.execution);
            solution.flight_wall_s = flight.wall_s;
            count_if_good(problem, solution);
        }
        if (solution.map) {
            solution.planning.map_wall_s = reading_wall_s + (solution.map->filling_s() - filling_before_s);
        }
    } catch (const WorkStopped&) {  // there is what was found before
    }
    if (solution.map && !options.map) {
        keep_map(options.map_cache, *solution.map);
    }
    solution.interrupted = options.stop.stop_requested();
    if (solution.execution) {
        solution.execution_cost = cost_of(*solution.execution, solution.objective);
    }
    return solution;
}

}  // namespace

bool needs_map(const Problem& problem, bool finds_stops) noexcept {
    const bool certifies = problem.uncertainty && problem.planner.certify;
    return problem.aero.enabled && (problem.planner.variant == Variant::mp_arm_ada || certifies || finds_stops);
}

Solution solve(const PlannableProblem& plannable, const SolveOptions& options) {
    return solve_checked(plannable, options, planning::Stopwatch());
}

Solution solve(const Problem& problem, const SolveOptions& options) {
    const planning::Stopwatch since_call;
    return solve_checked(plannable(problem), options, since_call);
}

}  // namespace downwash
