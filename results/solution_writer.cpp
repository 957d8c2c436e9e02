#include <nlohmann/json.hpp>
#include <span>

#include "downwash/base/version.hpp"
#include "downwash/results/input_json.hpp"
#include "downwash/results/json_parts.hpp"
#include "downwash/results/search_json.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash {
namespace {

Json knot_json(const ReferenceKnot& knot, const Plan& plan) {
    Json json = {{"t_s", static_cast<double>(knot.tick) * plan.tick_s}};
    const auto add = [&](std::string_view Axis::*name, const double(&numbers)[max_axes]) {
        for (std::size_t i = 0; i < plan.axes.size(); ++i) {
            json[std::string(plan.axes[i].*name)] = numbers[i];
        }
    };
    add(&Axis::position, knot.point.position);
    add(&Axis::velocity, knot.point.velocity);
    add(&Axis::acceleration, knot.point.acceleration);
    return json;
}

Json plan_json(const std::optional<Plan>& plan) {
    if (!plan) {
        return {};
    }
    Json waypoints = Json::array();
    Json reference = Json::array();
    for (const ReferenceKnot& knot : plan->reference) {
        waypoints.push_back(configuration_json(configuration_of(knot.point), plan->axes));
        reference.push_back(knot_json(knot, *plan));
    }
    return {{"waypoints", std::move(waypoints)}, {"reference", std::move(reference)}};
}

Json execution_json(const Solution& solution) {
    if (!solution.execution) {
        return {};
    }
    const Execution& flight = *solution.execution;
    Json goals = Json::array();
    for (const GoalVisit& visit : flight.goals) {
        goals.push_back({{"met", visit.is_met}, {"error_m", json_number(visit.error_m)}});
    }
    Json execution = {{"aero", flight.aero},
                      {"outcome", name_of(flight.outcome)},
                      {"min_clearance_m", json_number(flight.min_clearance_m)},
                      {"energy_j", json_number(flight.energy_j)},
                      {"duration_s", json_number(flight.duration_s)},
                      {"cost", json_number(solution.execution_cost)},
                      {"max_tracking_error_m", json_number(flight.max_tracking_error_m)},
                      {"max_saturation", json_number(flight.max_saturation)},
                      {"goal_error_m", json_number(flight.goal_error_m)},
                      {"goals", std::move(goals)}};
    if (flight.unseen_share) {
        execution["unseen_share"] = *flight.unseen_share;
    }
    if (flight.touch) {
        execution["contact"] = touch_json(*flight.touch);
    }
    if (solution.execution_world) {
        execution["world"] = {{"index", solution.execution_world->index}, {"seed", solution.execution_world->seed}};
        execution["lateral_m"] = json_number(flight.lateral_m);
    }
    return execution;
}

}  // namespace

std::string solution_json(const Solution& solution, const ProblemReference& problem, const FileDigests& files) {
    Json document = {
        {"schema", solution_schema},
        {"status", name_of(solution.status)},
        {"interrupted", solution.interrupted},
        {"problem", {{"name", problem.name}, {"file", problem.file}, {"sha256", problem.sha256}}},
        {"warnings", warnings_json(problem.warnings)},
        {"inputs", problem.inputs ? inputs_json(*problem.inputs) : Json()},
        {"variant", name_of(solution.variant)},
        {"algorithm", solution.algorithm},
        {"objective", objective_json(solution.objective)},
        {"seed", solution.seed},
        {"version", version()},
        {"threads", solution.threads},
        {"cost", solution.plan ? json_number(solution.cost) : Json()},
        {"planning", planning_json<planning::Plane>(solution, solution.planning, problem.axes)},
        {"certificate", certificate_json(solution.certificate)},
        {"plan", plan_json(solution.plan)},
        {"stops", stops_json(solution.safe_stops, solution.plan ? solution.plan->tick_s : 0, problem.axes)},
        {"execution", execution_json(solution)},
        {"files", files},
    };
    if (solution.replanned) {
        document["replanned"] = replanned_json(*solution.replanned);
    }
    if (solution.order) {
        document["order"] = order_json(*solution.order);
    }
    // A file name may be any bytes; what is no UTF-8 in it is replaced.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace downwash
