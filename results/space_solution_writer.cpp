#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "downwash/base/version.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/results/input_json.hpp"
#include "downwash/results/json_parts.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

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

Json execution_json(const SpaceSolution& solution) {
    if (!solution.execution) {
        return {};
    }
    const SpaceFlight& flight = *solution.execution;
    Json execution = {{"aero", solution.aero},
                      {"outcome", name_of(flight.outcome)},
                      {"min_clearance_m", json_number(flight.min_clearance_m)},
                      {"energy_j", json_number(flight.energy_j)},
                      {"duration_s", json_number(flight.duration_s)},
                      {"cost", json_number(cost_of(flight, solution.objective))},
                      {"max_tracking_error_m", json_number(flight.max_tracking_error_m)},
                      {"max_saturation", json_number(flight.max_saturation)}};
    if (solution.execution_world) {
        execution["world"] = {{"index", solution.execution_world->index}, {"seed", solution.execution_world->seed}};
    }
    return execution;
}

}  // namespace

std::optional<double> cost_of(const SpaceFlight& flight, const CostFunction& objective) {
    if (objective.weight(Objective::length) > 0 || objective.weight(Objective::clearance) > 0) {
        return std::nullopt;
    }
    CostFigures figures;
    figures.energy_j = flight.energy_j;
    figures.time_s = flight.duration_s;
    return objective(figures);
}

std::string solution_json(const SpaceSolution& solution, const SpaceProblemReference& problem,
                          const FileDigests& files) {
    const Json document = {
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
        {"cost", nullptr},         // that of a search
        {"planning", nullptr},     // its record
        {"certificate", nullptr},  // what it flew in worlds
        {"plan", plan_json(solution.plan)},
        {"stops", nullptr},
        {"execution", execution_json(solution)},
        {"files", files},
    };
    // A file name may be any bytes; what is no UTF-8 in it is replaced.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace downwash
