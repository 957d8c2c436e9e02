#pragma once

// Private to results/.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "downwash/controllers/axes.hpp"
#include "downwash/planner/found.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/results/json_parts.hpp"

// What solution.json says of a search, in the plane and in space.

namespace downwash {

using Json = nlohmann::ordered_json;

/// The coordinates of a configuration by the names of their axes.
template <class AnyConfiguration>
Json configuration_json(const AnyConfiguration& at, std::span<const Axis> axes) {
    Json json;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        json[std::string(axes[i].position)] = json_number(at[i]);
    }
    return json;
}

template <class AnyObstruction>
Json obstruction_json(const std::optional<AnyObstruction>& obstruction, std::span<const Axis> axes) {
    if (!obstruction) {
        return {};
    }
    Json json = {{"cause", obstruction->cause}};
    json.update(configuration_json(obstruction->at, axes));
    json["goal_distance_m"] = json_number(obstruction->goal_distance_m);
    json["obstacles"] = obstruction->obstacles;
    return json;
}

inline Json certificate_json(const std::optional<Certificate>& certificate) {
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
inline Json order_json(const VisitOrder& order) {
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

template <class Family>
Json stops_json(const std::optional<SafeStopsOf<Family>>& stops, double tick_s, std::span<const Axis> axes) {
    if (!stops) {
        return {};
    }
    Json moments = Json::array();
    for (const auto& moment : stops->moments) {
        Json each = {{"t_s", static_cast<double>(moment.tick) * tick_s}, {"safe", moment.rest.has_value()}};
        if (moment.rest) {
            each["rest"] = configuration_json(*moment.rest, axes);
            each["duration_s"] = moment.duration_s;
        }
        moments.push_back(std::move(each));
    }
    return {{"share_without", stops->share_without}, {"moments", std::move(moments)}};
}

inline Json replanned_json(const Replanned& from) {
    return {{"plan", from.plan},
            {"t_s", from.t_s},
            {"tick", from.tick},
            {"rest", {{"outcome", name_of(from.rest_outcome)}, {"cost", json_number(from.rest_cost)}}},
            {"same_reference_s", from.same_reference_s ? json_number(*from.same_reference_s) : Json()}};
}

template <class Family>
Json planning_json(const FoundOf<Family>& found, const SearchRecord& record, std::span<const Axis> axes) {
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

}  // namespace downwash
