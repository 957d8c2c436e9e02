#pragma once

// Private to results/.

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_configuration.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/planner/safe_stops.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/results/json_reader.hpp"

namespace downwash::problems {

/// The plan of a solution file, as it stands there.
struct PlanText {
    Plan plan;
    std::vector<Configuration> waypoints;
    std::optional<Node> waypoints_node, reference_node;
};

/// The same of a plan in space.
struct SpacePlanText {
    SpacePlan plan;
    std::vector<SpacePoint> waypoints;  ///< at rest; empty if the file has none
    std::optional<Node> waypoints_node, reference_node;
};

/// Reads a coordinate for each axis; errors go to the reader.
[[nodiscard]] Configuration read_configuration(JsonReader& reader, const Node& group, std::span<const Axis> axes);

/// The same in space.
[[nodiscard]] SpaceConfiguration read_space_configuration(JsonReader& reader, const Node& group, int joints);

/// Reads `stops`. @param read_rest reads where one ends
template <class Family, class ReadRest>
void read_stops(JsonReader& reader, const Node& root, double tick_s, std::optional<SafeStopsOf<Family>>& into,
                const ReadRest& read_rest) {
    const auto node = reader.optional_group(root, "stops");
    if (!node) {
        return;
    }
    SafeStopsOf<Family>& stops = into.emplace();
    stops.share_without = reader.amount(*node, "share_without", 0);
    for (const Node& each : reader.groups(JsonReader::member(*node, "moments"))) {
        auto& moment = stops.moments.emplace_back();
        moment.tick = std::llround(reader.amount(each, "t_s", 0) / tick_s);
        bool is_safe = false;
        reader.read_flag(each, "safe", is_safe);
        if (const auto rest = JsonReader::member(each, "rest"); is_safe && rest) {
            moment.rest = read_rest(*rest);
            moment.duration_s = reader.amount(each, "duration_s", 0);
        }
    }
}

/// Reads `plan`; errors go to the reader. @param problem on whose control ticks knots have to stand
[[nodiscard]] PlanText read_plan(JsonReader& reader, const Node& root, const Problem& problem);

/// Reads the `plan` of a file in space. No key of a knot may be unknown; `waypoints` may be missing, and so may rates
/// and accelerations of a knot, which are then 0.
[[nodiscard]] SpacePlanText read_plan(JsonReader& reader, const Node& root, const SpaceProblem& problem);

}  // namespace downwash::problems
