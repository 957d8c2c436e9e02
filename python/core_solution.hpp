#pragma once

#include <memory>

#include "downwash/planner/solution.hpp"
#include "downwash/python/core.hpp"

namespace downwash::python {

/// A solution and the problem that it is of.
struct CoreSolution {
    std::shared_ptr<const CoreProblem> of;
    Solution solution;
};

/// A problem with its goals in the order in which a plan visits them.
/// @throws InputError if the plan is of other targets
[[nodiscard]] Problem as_visited(const Problem& problem, const Solution& solution);

}  // namespace downwash::python
