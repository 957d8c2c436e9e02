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

}  // namespace downwash::python
