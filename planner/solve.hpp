#pragma once

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {

/// Plans, and flies the plan with direct aerodynamics, hold included.
/// An aerodynamics-aware plan whose direct flight fails or comes nearer to an obstacle than the margin, at any tick, is
/// discarded and the search goes on; the other variants' plans are reported with their failed flight. Never prints,
/// never exits. While it runs OMPL's log, one for the whole process, is silent; OMPL's global seeds are neither needed
/// nor set.
[[nodiscard]] DOWNWASH_EXPORT Solution solve(const PlannableProblem& plannable, const SolveOptions& options = {});

/// Plans for a problem that is checked first.
/// @throws InputError with every error when the problem cannot be planned
[[nodiscard]] DOWNWASH_EXPORT Solution solve(const Problem& problem, const SolveOptions& options = {});

}  // namespace downwash
