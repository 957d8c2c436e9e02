#pragma once

#include "downwash/base/export.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/search_result.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash::planning {

/// Chooses in which order the targets of a problem are visited, which of their alternatives are approached and, under
/// an energy budget, which targets are left out; and plans the flight. First a whole flight in the order that is best
/// by estimates of its legs; where time alone is limited, that search may take all of it, so that a list in the same
/// order has its first flight no sooner. In space, where estimates know the ways around obstacles, and with more
/// targets than an order can be proven best for, this is all. Else orders are compared by flown legs (LegTable): the
/// best order by what is known is flown leg by leg until it consists of flown legs. What is left of the limits goes
/// into the flight in that order. The best flight counts: most targets, then the lowest cost. A target to which no
/// flight is found makes it `approximate`; one for which the energy is not enough does not.
/// @pre the problem has targets
[[nodiscard]] DOWNWASH_EXPORT SearchResult search_in_any_order(const Problem& problem, const PlannerModel& model,
                                                               const SolveOptions& options);

/// The same in space.
[[nodiscard]] SearchResultOf<Space> search_in_any_order(const SpaceProblem& problem, const PlannerModelOf<Space>& model,
                                                        const SolveOptionsOf<Space>& options);

}  // namespace downwash::planning
