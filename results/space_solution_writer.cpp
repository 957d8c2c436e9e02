#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "downwash/base/version.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/results/input_json.hpp"
#include "downwash/results/json_parts.hpp"
#include "downwash/results/search_json.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash {
namespace {

Json plan_json(const std::optional<SpacePlan>& plan) {
    if (!plan) {
        return {};
    }
    const std::span<const Axis> axes = axes_in_space(plan->joints);
    Json waypoints = Json::array();
    Json reference = Json::array();
    for (const SpaceKnot& knot : plan->reference) {
        Json waypoint;
        Json at = {{"t_s", static_cast<double>(knot.tick) * plan->tick_s}};
        const auto add = [&axes](Json& json, std::string_view Axis::*name, const auto& numbers) {
            for (std::size_t i = 0; i < axes.size(); ++i) {
                json[std::string(axes[i].*name)] = numbers[i];
            }
        };
        add(waypoint, &Axis::position, knot.point.position);
        add(at, &Axis::position, knot.point.position);
        add(at, &Axis::velocity, knot.point.velocity);
        add(at, &Axis::acceleration, knot.point.acceleration);
        waypoints.push_back(std::move(waypoint));
        reference.push_back(std::move(at));
    }
    return {{"waypoints", std::move(waypoints)}, {"reference", std::move(reference)}};
}

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
    Json execution = {{"aero", solution.aero},
                      {"outcome", name_of(flight.outcome)},
                      {"min_clearance_m", json_number(flight.min_clearance_m)},
                      {"energy_j", json_number(flight.energy_j)},
                      {"duration_s", json_number(flight.duration_s)},
                      {"cost", json_number(cost_of(flight, solution.objective))},
                      {"max_tracking_error_m", json_number(flight.max_tracking_error_m)},
                      {"max_saturation", json_number(flight.max_saturation)},
                      {"goal_error_m", json_number(worst_goal_error_m(flight))},
                      {"goals", std::move(goals)}};
    if (solution.execution_world) {
        execution["world"] = {{"index", solution.execution_world->index}, {"seed", solution.execution_world->seed}};
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
    const std::span<const Axis> axes = axes_in_space(solution.joints);
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
        {"cost", search != nullptr && solution.plan ? json_number(search->cost) : Json()},
        {"planning", search != nullptr ? planning_json<planning::Space>(*search, search->planning, axes) : Json()},
        {"certificate", search != nullptr ? certificate_json(search->certificate) : Json()},
        {"plan", plan_json(solution.plan)},
        {"stops", stops_json(solution.safe_stops, solution.plan ? solution.plan->tick_s : 0, axes)},
        {"execution", execution_json(solution)},
        {"files", files},
    };
    if (solution.order) {
        document["order"] = order_json(*solution.order);
    }
    if (solution.replanned) {
        document["replanned"] = replanned_json(*solution.replanned);
    }
    // A file name may be any bytes; what is no UTF-8 in it is replaced.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace downwash
