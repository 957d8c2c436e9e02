#pragma once

#include "downwash/base/export.hpp"
#include "downwash/planner/candidate_check.hpp"

namespace downwash::planning {

/// Searches for the way to one goal with the algorithm that the problem names. Its settings hold limits and seed.
/// @param part a problem with a single goal, whose start is at the end of the course before
/// @param whole the problem that it is a part of, or itself
/// @return cost and plan from the part's start on; the execution, if there is one, of course and plan together
[[nodiscard]] DOWNWASH_EXPORT SearchResult search_goal(const Problem& part, const Problem& whole,
                                                       const PlannerModel& model, const Course& before,
                                                       const PlanChecks& checks, const SolveOptions& options);

/// The same in space.
[[nodiscard]] SearchResultOf<Space> search_goal(const SpaceProblem& part, const SpaceProblem& whole,
                                                const PlannerModelOf<Space>& model, const CourseOf<Space>& before,
                                                const PlanChecksOf<Space>& checks,
                                                const SolveOptionsOf<Space>& options);

}  // namespace downwash::planning
