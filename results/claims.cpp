#include "downwash/results/claims.hpp"

#include <utility>

#include "downwash/results/order_reader.hpp"
#include "downwash/results/plan_reader.hpp"
#include "downwash/results/solution_document.hpp"

namespace downwash {
namespace {

using problems::JsonReader;
using problems::Node;

void read_flight(JsonReader& reader, const Node& root, std::optional<FlightClaims>& into) {
    const auto node = reader.optional_group(root, "execution");
    if (!node) {
        return;
    }
    FlightClaims& flight = into.emplace();
    reader.read_flag(*node, "aero", flight.aero);
    if (const auto outcome = reader.required(*node, "outcome"); outcome && outcome->json->is_string()) {
        flight.outcome = outcome->json->get<std::string>();
    } else if (outcome) {
        reader.report(*outcome, "expected a name");
    }
    if (const auto clearance = reader.required(*node, "min_clearance_m"); clearance && !clearance->json->is_null()) {
        flight.min_clearance_m = reader.figure(*clearance);
    }
    const auto amount = [&](const char* name) {
        const auto member = reader.required(*node, name);
        return member && !member->json->is_null() ? reader.amount(*node, name, 0) : 0;
    };
    flight.energy_j = amount("energy_j");
    flight.duration_s = amount("duration_s");
    flight.cost = amount("cost");
    flight.goal_error_m = amount("goal_error_m");
    if (const auto world = JsonReader::member(*node, "world"); world && world->json->is_object()) {
        flight.world = FlightClaims::WorldIndex{};
        reader.read_count(*world, "index", flight.world->index);
        reader.read_count(*world, "seed", flight.world->seed);
    }
}

void read_certificate(JsonReader& reader, const Node& root, std::optional<double>& certified_share) {
    const auto node = reader.optional_group(root, "certificate");
    if (!node) {
        return;
    }
    bool is_given = false;
    reader.read_flag(*node, "given", is_given);
    if (is_given) {
        certified_share = reader.amount(*node, "max_failure_probability", 0);
    }
}

}  // namespace

Claims read_claims(const std::string& path, const Problem& problem) {
    Claims claims;
    claims.objective = problem.planner.objective;
    claims.seed = problem.planner.seed;
    problems::read_document(path, [&](JsonReader& reader, const Node& root) {
        problems::read_objective(reader, root, claims.objective);
        reader.read_count(root, "seed", claims.seed);
        problems::PlanText text = problems::read_plan(reader, root, problem);
        claims.plan = std::move(text.plan);
        claims.waypoints = std::move(text.waypoints);
        claims.order = problems::read_order(reader, root, problem);
        read_flight(reader, root, claims.flight);
        read_certificate(reader, root, claims.certified_share);
    });
    return claims;
}

SpaceClaims read_claims(const std::string& path, const SpaceProblem& problem) {
    SpaceClaims claims;
    claims.objective = problem.planner.objective;
    claims.seed = problem.planner.seed;
    problems::read_document(path, [&](JsonReader& reader, const Node& root) {
        problems::read_objective(reader, root, claims.objective);
        reader.read_count(root, "seed", claims.seed);
        problems::SpacePlanText text = problems::read_plan(reader, root, problem);
        claims.plan = std::move(text.plan);
        claims.waypoints = std::move(text.waypoints);
        claims.has_waypoints = text.waypoints_node.has_value();
        claims.order = problems::read_order(reader, root, problem);
        read_flight(reader, root, claims.flight);
        if (const auto node = reader.optional_group(root, "execution")) {
            const auto cost = JsonReader::member(*node, "cost");
            claims.has_cost = cost && !cost->json->is_null();
        }
    });
    return claims;
}

}  // namespace downwash
