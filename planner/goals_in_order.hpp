#pragma once

#include <cstdint>

#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/search_result.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash::planning {

/// Plans the way to one goal, or through several in their order, with what plans have to pass: worlds and
/// certificates where the problem has an uncertainty, and stops if the options ask for them.
/// @param problem without targets   @param effort for several goals
/// @param attempts plans that asked for a certificate before
[[nodiscard]] SearchResult search_in_order(const Problem& problem, const PlannerModel& model,
                                           const SolveOptions& options, const SequenceEffort& effort = {},
                                           std::uint64_t attempts = 0);

/// The same in space. @param problem whose goals come in their order
[[nodiscard]] SearchResultOf<Space> search_in_order(const SpaceProblem& problem, const PlannerModelOf<Space>& model,
                                                    const SolveOptionsOf<Space>& options,
                                                    const SequenceEffortOf<Space>& effort = {},
                                                    std::uint64_t attempts = 0);

/// Whether an end was asked for, for the last flight of a plan that was not flown yet. A stop that came before leaves
/// it a moment, which is plenty in most scenes: whoever interrupts wants to know what the plan is worth.
[[nodiscard]] StopCondition end_of_last_flight(const std::stop_token& stop);

}  // namespace downwash::planning
