#include "downwash/planner/line_search.hpp"

#include <utility>

#include "downwash/ompl_planners/geometric_planners.hpp"
#include "downwash/planner/search_clock.hpp"
#include "downwash/search/planned_flights.hpp"

namespace downwash::planning {

SearchResult search_lines(const Problem& problem, const FlightModel& model, const SolveOptions& options) {
    const SearchTask task(problem, model, nullptr);
    Random random(problem.planner.seed);
    SearchClock search(problem.planner, options);
    GeometricHooks hooks;
    hooks.keep_tree = options.keep_tree;
    hooks.is_over = [&](const GeometricProgress& progress) {
        search.note(progress.iteration, progress.nodes, progress.rejected);
        return search.is_over() ||
               (problem.planner.max_iterations && progress.iteration >= *problem.planner.max_iterations);
    };
    hooks.on_improvement = [&](double cost, std::uint64_t iteration) {
        const double now_s = search.seconds();
        search.found_first(now_s);
        search.improved(now_s, cost, iteration, {});
    };
    GeometricResult result = plan_geometrically(task, random, hooks);
    Found found;
    found.tree = std::move(result.tree);
    SearchRecord record = search.record;
    record.wall_s = search.seconds();
    record.iterations = result.iterations;
    record.states_checked = result.counts.states;
    record.rejected = no_rejections();
    record.rejected["collision"] = result.counts.rejected_collision;
    record.rejected["bounds"] = result.counts.rejected_bounds;
    record.rejected["arm_limits"] = result.counts.rejected_arm_limits;
    if (result.status != Status::solved) {
        found.nearest_approach_m = result.nearest_approach_m;
    }
    if (result.plan && result.plan->reference.back().tick > max_plan_ticks) {
        record.rejected["too_long"] = 1;
        record.improvements.clear();
        record.first_solution_wall_s.reset();
        return {std::move(found), std::move(record)};
    }
    found.status = result.status;
    found.plan = std::move(result.plan);
    found.cost = result.cost;
    if (options.on_plan && found.status == Status::solved) {
        options.on_plan({*found.plan, found.cost, {}});
    }
    return {std::move(found), std::move(record)};
}

}  // namespace downwash::planning
