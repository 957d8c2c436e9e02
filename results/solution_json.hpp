#pragma once

// Private to results/.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "downwash/base/version.hpp"
#include "downwash/controllers/axes.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/results/input_json.hpp"
#include "downwash/results/json_parts.hpp"
#include "downwash/results/search_json.hpp"
#include "downwash/results/solution_file.hpp"

// solution.json of both families: they differ in the axes, and in what a flight says of goals and touches.

namespace downwash {

inline std::span<const Axis> axes_of(const Plan& plan) {
    return plan.axes;
}
inline std::span<const Axis> axes_of(const SpacePlan& plan) {
    return axes_in_space(plan.joints);
}

template <class AnyPlan>
Json plan_json(const std::optional<AnyPlan>& plan) {
    if (!plan) {
        return {};
    }
    const std::span<const Axis> axes = axes_of(*plan);
    const auto add = [axes](Json& json, std::string_view Axis::*name, const auto& numbers) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            json[std::string(axes[i].*name)] = json_number(numbers[i]);
        }
    };
    Json waypoints = Json::array();
    Json reference = Json::array();
    for (const auto& knot : plan->reference) {
        Json waypoint;
        Json at = {{"t_s", static_cast<double>(knot.tick) * plan->tick_s}};
        add(waypoint, &Axis::position, knot.point.position);
        add(at, &Axis::position, knot.point.position);
        add(at, &Axis::velocity, knot.point.velocity);
        add(at, &Axis::acceleration, knot.point.acceleration);
        waypoints.push_back(std::move(waypoint));
        reference.push_back(std::move(at));
    }
    return {{"waypoints", std::move(waypoints)}, {"reference", std::move(reference)}};
}

/// What flights of both families have. @param cost by the objective of the solution
template <class AnyFlight>
Json flight_json(const AnyFlight& flight, bool aero, double cost, double goal_error_m, Json goals) {
    return {{"aero", aero},
            {"outcome", name_of(flight.outcome)},
            {"min_clearance_m", json_number(flight.min_clearance_m)},
            {"energy_j", json_number(flight.energy_j)},
            {"duration_s", json_number(flight.duration_s)},
            {"cost", json_number(cost)},
            {"max_tracking_error_m", json_number(flight.max_tracking_error_m)},
            {"max_saturation", json_number(flight.max_saturation)},
            {"goal_error_m", json_number(goal_error_m)},
            {"goals", std::move(goals)}};
}

inline Json world_json(const ExecutionWorld& world) {
    return {{"index", world.index}, {"seed", world.seed}};
}

/// The whole text. @param found by the search, with its record; nullptr: the plan was given
template <class Family, class AnySolution, class AnyReference>
std::string solution_text(const AnySolution& solution, const AnyReference& problem, std::span<const Axis> axes,
                          const FoundOf<Family>* found, const SearchRecord* record, Json execution,
                          const FileDigests& files) {
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
        {"cost", found != nullptr && solution.plan ? json_number(found->cost) : Json()},
        {"planning", found != nullptr ? planning_json<Family>(*found, *record, axes) : Json()},
        {"certificate", found != nullptr ? certificate_json(found->certificate) : Json()},
        {"plan", plan_json(solution.plan)},
        {"stops", stops_json(solution.safe_stops, solution.plan ? solution.plan->tick_s : 0, axes)},
        {"execution", std::move(execution)},
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
