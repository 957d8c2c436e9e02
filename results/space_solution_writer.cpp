#include "downwash/results/space_solution_file.hpp"

#include <algorithm>
#include <utility>

#include "downwash/controllers/space_axes.hpp"
#include "downwash/results/solution_json.hpp"

namespace downwash {
namespace {

Json goal_json(const SpaceGoalVisit& visit) {
    Json goal = {{"met", visit.is_met},
                 {"error_m", json_number(visit.error_m)},
                 {"angle_rad", json_number(visit.angle_rad)},
                 {"hidden", visit.is_hidden}};
    if (const auto& touch = visit.touch) {
        Json& contact = goal["contact"] = touch_json(*touch);
        contact["end"] = name_of(touch->end);
        contact["place_m"] = touch->place_m;
        contact["slip_m"] = json_number(touch->slip_m);
    }
    return goal;
}

Json execution_json(const SpaceSolution& solution) {
    if (!solution.execution) {
        return {};
    }
    const SpaceFlight& flight = *solution.execution;
    Json goals = Json::array();
    for (const SpaceGoalVisit& visit : flight.goals) {
        goals.push_back(goal_json(visit));
    }
    Json execution = flight_json(flight, solution.aero, cost_of(flight, solution.objective), worst_goal_error_m(flight),
                                 std::move(goals));
    if (solution.execution_world) {
        execution["world"] = world_json(*solution.execution_world);
    }
    return execution;
}

}  // namespace

SpaceSolution solution_of(const SpaceProblem& problem, std::shared_ptr<const SpaceSearchResult> search, int threads) {
    SpaceSolution solution;
    solution.status = search->status;
    solution.interrupted = search->interrupted;
    solution.variant = problem.planner.variant;
    solution.algorithm = problem.planner.algorithm;
    solution.objective = problem.planner.objective;
    solution.seed = problem.planner.seed;
    solution.threads = threads;
    solution.joints = problem.robot.joints();
    solution.plan = search->plan;
    solution.execution = search->execution;
    solution.aero = problem.aero.enabled;
    solution.order = search->order;
    solution.safe_stops = search->safe_stops;
    solution.search = std::move(search);
    return solution;
}

double worst_goal_error_m(const SpaceFlight& flight) noexcept {
    double worst_m = 0;
    for (const SpaceGoalVisit& visit : flight.goals) {
        worst_m = std::max(worst_m, visit.error_m);
    }
    return worst_m;
}

std::string solution_json(const SpaceSolution& solution, const SpaceProblemReference& problem,
                          const FileDigests& files) {
    const SpaceSearchResult* const search = solution.search.get();
    return solution_text<planning::Space>(solution, problem, axes_in_space(solution.joints), search,
                                          search != nullptr ? &search->planning : nullptr, execution_json(solution),
                                          files);
}

}  // namespace downwash
