#pragma once

#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"

namespace downwash::planning {

/// MP-ARM: searches a path of straight lines to the goal of a problem without stops.
void search_lines(const Problem& problem, const FlightModel& model, const SolveOptions& options, Solution& solution);

}  // namespace downwash::planning
