#pragma once

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {

/// Plans, and flies the plan with direct aerodynamics, hold included.
/// A plan whose direct flight fails or comes nearer to an obstacle than the margin, at any tick, is discarded and the
/// search goes on, whatever the variant; without PlannerSettings::check_execution it is reported with its failed
/// flight. Never prints, never exits. While it runs OMPL's log, one for the whole process, is silent; OMPL's global
/// seeds are neither needed nor set.
[[nodiscard]] DOWNWASH_EXPORT Solution solve(const PlannableProblem& plannable, const SolveOptions& options = {});

/// Whether solve() needs the aero map of a problem: to plan through it, or for certificates or stops.
[[nodiscard]] DOWNWASH_EXPORT bool needs_map(const Problem& problem, bool finds_stops) noexcept;

/// Plans for a problem that is checked first.
/// @throws InputError with every error when the problem cannot be planned
[[nodiscard]] DOWNWASH_EXPORT Solution solve(const Problem& problem, const SolveOptions& options = {});

}  // namespace downwash
