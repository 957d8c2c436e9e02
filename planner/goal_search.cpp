#include "downwash/planner/goal_search.hpp"

#include <utility>

#include "downwash/ompl_planners/control_planners.hpp"
#include "downwash/ompl_planners/geometric_planners.hpp"
#include "downwash/search/flight_space.hpp"
#include "downwash/search/flight_tree_planner.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/tree_record.hpp"

namespace downwash::planning {
namespace {

/// The hooks of a search by one of OMPL's planners.
OmplHooks hooks_of(CandidateCheck& check, const SolveOptions& options) {
    OmplHooks hooks;
    hooks.keep_tree = options.keep_tree;
    hooks.is_over = [&check](const OmplProgress& progress) {
        check.clock().note(progress.iteration, progress.nodes, progress.rejected);
        const std::optional<std::uint64_t>& most = check.task().problem.planner.max_iterations;
        return check.is_over() || (most && progress.iteration >= *most);
    };
    hooks.accept = [&check](const Plan& plan, double cost, std::uint64_t iteration) {
        const bool counts = check.counts(plan, cost);
        if (counts) {
            check.accept(plan, cost, iteration);
        }
        return counts;
    };
    return hooks;
}

SearchResult result_of(CandidateCheck& check, OmplResult found, const FlightStatistics& statistics) {
    return check.result(found.iterations, statistics, std::move(found.tree),
                        {found.status, std::move(found.plan), found.cost, found.nearest_approach_m});
}

/// OMPL's planners on straight lines.
SearchResult search_lines(CandidateCheck& check, const SolveOptions& options) {
    Random random(check.task().problem.planner.seed);
    GeometricResult found = plan_geometrically(check.task(), random, hooks_of(check, options));
    FlightStatistics statistics;
    statistics.states_checked = found.counts.states;
    statistics.rejected = no_rejections();
    statistics.rejected["collision"] = found.counts.rejected_collision;
    statistics.stopped_by = found.counts.stopped_by;
    statistics.rejected["bounds"] = found.counts.rejected_bounds;
    statistics.rejected["arm_limits"] = found.counts.rejected_arm_limits;
    statistics.rejected["direct_flight"] = found.discarded;
    return result_of(check, std::move(found), statistics);
}

/// OMPL's planners over controls.
SearchResult search_controls(CandidateCheck& check, const SolveOptions& options) {
    Random random(check.task().problem.planner.seed);
    PlannedFlights planned(
        check.task(), [&check] { return check.is_over(); }, options.threads);
    const SteeredFlights flights(planned);
    OmplResult found = plan_by_controls(flights, random, hooks_of(check, options));
    return result_of(check, std::move(found), planned.statistics());
}

/// Our own planner, the same for all levels of awareness.
SearchResult search_tree(CandidateCheck& check, const SolveOptions& options) {
    const QuietOmpl quiet;
    const PlannerSettings& settings = check.task().problem.planner;
    const double tick_s = check.task().model.tick().tick_s;
    Random random(settings.seed);
    const OmplTask task(check.task(), random);
    FlightTreePlanner planner(task.information, check.task(), options.threads);
    planner.setProblemDefinition(task.definition);
    planner.set_hooks({[&](const Candidate& candidate) {
                           return check.counts(plan_through(candidate.moments, tick_s), candidate.cost);
                       },
                       [&] { return check.new_counterexamples(); },
                       [&](const Candidate& candidate) {
                           check.accept(plan_through(candidate.moments, tick_s), candidate.cost, candidate.iteration);
                       }});
    planner.set_max_iterations(settings.max_iterations);
    planner.set_stops_at_first_plan(options.stop_at_first_solution);
    planner.set_known(options.known_plan, options.known_places);
    planner.set_observer([&] {
        check.clock().note(planner.iterations(), planner.growth().tree().size(), planner.statistics().rejections);
    });
    planner.setup();
    planner.solve(ompl::base::PlannerTerminationCondition([&check] { return check.is_over(); }));

    std::vector<TreeNode> tree;
    if (options.keep_tree) {
        tree = tree_of(planner,
                       [](const ompl::base::State* state) { return configuration_of(point_of(state).reference); });
    }
    const FlightNode& nearest = planner.growth().nearest_to_goal();
    Approach approach;
    approach.nearest_m = planner.growth().nearest_distance_m();
    if (nearest.parent != nullptr) {
        approach.status = Status::approximate;
        approach.plan = planner.growth().tree().plan_to(nearest);
        approach.cost = nearest.cost;
    }
    return check.result(planner.iterations(), planner.statistics(), std::move(tree), approach);
}

}  // namespace

SearchResult search_goal(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                         const PlanChecks& checks, const SolveOptions& options) {
    CandidateCheck check(part, whole, model, before, checks, options);
    if (part.planner.algorithm == "rrt-star") {
        return search_tree(check, options);
    }
    return plans_flights(part.planner.variant) ? search_controls(check, options) : search_lines(check, options);
}

}  // namespace downwash::planning
