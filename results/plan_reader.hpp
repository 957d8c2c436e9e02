#pragma once

// Private to results/.

#include <optional>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/results/json_reader.hpp"

namespace downwash::problems {

/// The plan of a solution file, as it stands there.
struct PlanText {
    Plan plan;
    std::vector<Configuration> waypoints;
    std::optional<Node> waypoints_node, reference_node;
};

/// Reads a coordinate for each axis; errors go to the reader.
[[nodiscard]] Configuration read_configuration(JsonReader& reader, const Node& group);

/// Reads `plan`; errors go to the reader. @param tick_s control period, on which knots have to stand
[[nodiscard]] PlanText read_plan(JsonReader& reader, const Node& root, double tick_s);

}  // namespace downwash::problems
