#pragma once

#include "downwash/planner/search_result.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::planning {

/// MP-ARM: searches a path of straight lines to the goal of a problem with a single goal.
[[nodiscard]] SearchResult search_lines(const Problem& problem, const FlightModel& model, const SolveOptions& options);

}  // namespace downwash::planning
