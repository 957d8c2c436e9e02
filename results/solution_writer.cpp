#include <nlohmann/json.hpp>
#include <span>

#include "downwash/base/version.hpp"
#include "downwash/results/input_json.hpp"
#include "downwash/results/json_parts.hpp"
#include "downwash/results/solution_file.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

/// The coordinates of a configuration by the names of their axes.
Json configuration_json(const Configuration& at, std::span<const Axis> axes) {
    Json json;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        json[std::string(axes[i].position)] = json_number(at[i]);
    }
    return json;
}

Json obstruction_json(const std::optional<Obstruction>& obstruction, std::span<const Axis> axes) {
    if (!obstruction) {
        return {};
    }
    Json json = {{"cause", obstruction->cause}};
    json.update(configuration_json(obstruction->at, axes));
    json["goal_distance_m"] = json_number(obstruction->goal_distance_m);
    json["obstacles"] = obstruction->obstacles;
    return json;
}

Json certificate_json(const std::optional<Certificate>& certificate) {
    if (!certificate) {
        return {};
    }
    Json worst = Json::array();
    for (const WorldSample& each : certificate->worst) {
        worst.push_back({{"world", each.world},
                         {"outcome", name_of(each.outcome)},
                         {"min_clearance_m", json_number(each.min_clearance_m)}});
    }
    const auto clearance_m = [&](double quantile_m) {
        return certificate->worlds > 0 ? json_number(quantile_m) : Json{};  // of no flight there is none
    };
    const auto& clearance = certificate->clearance_m;
    const auto& probability = certificate->failure_probability;
    return {{"given", certificate->is_given},
            {"worlds", certificate->worlds},
            {"failures", certificate->failures},
            {"failure_probability",
             {{"estimate", probability.estimate}, {"low", probability.low}, {"high", probability.high}}},
            {"max_failure_probability", certificate->max_failure_probability},
            {"confidence", certificate->confidence},
            {"attempts", certificate->attempts},
            {"clearance_m",
             {{"p01", clearance_m(clearance.p01)},
              {"p10", clearance_m(clearance.p10)},
              {"p50", clearance_m(clearance.p50)}}},
            {"causes", certificate->causes},
            {"worst", std::move(worst)}};
}

/// Targets and alternatives by their numbers from 1.
Json order_json(const VisitOrder& order) {
    Json visits = Json::array();
    for (const Visit& visit : order.visits) {
        visits.push_back(
            {{"target", visit.target + 1}, {"alternative", visit.alternative ? Json(*visit.alternative + 1) : Json()}});
    }
    Json left_out = Json::array();
    for (const LeftOutTarget& each : order.left_out) {
        left_out.push_back(
            {{"target", each.target + 1}, {"reason", name_of(each.reason)}, {"energy_j", json_number(each.energy_j)}});
    }
    return {{"visits", std::move(visits)},
            {"left_out", std::move(left_out)},
            {"is_best", order.is_best},
            {"legs", order.legs},
            {"cost_of_legs", json_number(order.cost_of_legs)}};
}

Json planning_json(const Found& found, const SearchRecord& record, std::span<const Axis> axes) {
    Json improvements = Json::array();
    for (const Improvement& improvement : record.improvements) {
        improvements.push_back({{"wall_s", json_number(improvement.wall_s)},
                                {"iteration", improvement.iteration},
                                {"cost", json_number(improvement.cost)},
                                {"flown_cost", json_number(improvement.flown_cost)}});
    }
    return {{"wall_s", json_number(record.wall_s)},
            {"map_wall_s", json_number(record.map_wall_s)},
            {"flight_wall_s", json_number(found.flight_wall_s)},
            {"first_solution_wall_s", json_number(record.first_solution_wall_s)},
            {"first_certified_wall_s", json_number(record.first_certified_wall_s)},
            {"iterations", record.iterations},
            {"edges_simulated", record.edges_simulated},
            {"simulated_s", json_number(record.simulated_s)},
            {"states_checked", record.states_checked},
            {"improvements", std::move(improvements)},
            {"rejected", record.rejected},
            {"stopped_by", record.stopped_by},
            {"candidates",
             {{"checked", record.candidates.checked},
              {"failed_execution", record.candidates.failed_execution},
              {"failed_certificate", record.candidates.failed_certificate},
              {"worse_stops", record.candidates.worse_stops},
              {"unfinished", record.candidates.unfinished}}},
            {"nearest_approach_m", json_number(found.nearest_approach_m)},
            {"obstruction", obstruction_json(found.obstruction, axes)},
            {"goal", found.missed_goal ? Json(*found.missed_goal) : Json()}};
}

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

Json stops_json(const std::optional<SafeStops>& stops, double tick_s, std::span<const Axis> axes) {
    if (!stops) {
        return {};
    }
    Json moments = Json::array();
    for (const SafeStops::Moment& moment : stops->moments) {
        Json each = {{"t_s", static_cast<double>(moment.tick) * tick_s}, {"safe", moment.rest.has_value()}};
        if (moment.rest) {
            each["rest"] = configuration_json(*moment.rest, axes);
            each["duration_s"] = moment.duration_s;
        }
        moments.push_back(std::move(each));
    }
    return {{"share_without", stops->share_without}, {"moments", std::move(moments)}};
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
        {"planning", planning_json(solution, solution.planning, problem.axes)},
        {"certificate", certificate_json(solution.certificate)},
        {"plan", plan_json(solution.plan)},
        {"stops", stops_json(solution.safe_stops, solution.plan ? solution.plan->tick_s : 0, problem.axes)},
        {"execution", execution_json(solution)},
        {"files", files},
    };
    if (solution.replanned) {
        const Replanned& from = *solution.replanned;
        document["replanned"] = {
            {"plan", from.plan},
            {"t_s", from.t_s},
            {"tick", from.tick},
            {"rest", {{"outcome", name_of(from.rest_outcome)}, {"cost", json_number(from.rest_cost)}}},
            {"same_reference_s", from.same_reference_s ? json_number(*from.same_reference_s) : Json()}};
    }
    if (solution.order) {
        document["order"] = order_json(*solution.order);
    }
    // A file name may be any bytes; what is no UTF-8 in it is replaced.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace downwash
