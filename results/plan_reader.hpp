#pragma once

// Private to results/.

#include <optional>
#include <span>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
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

/// Reads `plan`; errors go to the reader. @param problem on whose control ticks knots have to stand
[[nodiscard]] PlanText read_plan(JsonReader& reader, const Node& root, const Problem& problem);

/// Reads the `plan` of a file in space. No key of a knot may be unknown; `waypoints` may be missing, and so may rates
/// and accelerations of a knot, which are then 0.
[[nodiscard]] SpacePlanText read_plan(JsonReader& reader, const Node& root, const SpaceProblem& problem);

}  // namespace downwash::problems
