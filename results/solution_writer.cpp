#include <utility>

#include "downwash/results/solution_json.hpp"

namespace downwash {
namespace {

Json execution_json(const Solution& solution) {
    if (!solution.execution) {
        return {};
    }
    const Execution& flight = *solution.execution;
    Json goals = Json::array();
    for (const GoalVisit& visit : flight.goals) {
        Json& goal = goals.emplace_back(Json{{"met", visit.is_met}, {"error_m", json_number(visit.error_m)}});
        if (visit.touch) {
            goal["contact"] = touch_json(*visit.touch);
        }
    }
    Json execution = flight_json(flight, flight.aero, solution.execution_cost, flight.goal_error_m, std::move(goals));
    if (flight.unseen_share) {
        execution["unseen_share"] = *flight.unseen_share;
    }
    if (flight.goals.size() == 1 && flight.goals.front().touch) {
        execution["contact"] = touch_json(*flight.goals.front().touch);
    }
    if (solution.execution_world) {
        execution["world"] = world_json(*solution.execution_world);
        execution["lateral_m"] = json_number(flight.lateral_m);
    }
    return execution;
}

}  // namespace

std::string solution_json(const Solution& solution, const ProblemReference& problem, const FileDigests& files) {
    return solution_text<planning::Plane>(solution, problem, problem.axes, &solution, &solution.planning,
                                          execution_json(solution), files);
}

}  // namespace downwash
