#pragma once

#include <functional>
#include <memory>

#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/python/core.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/search/family.hpp"

namespace downwash::python {

/// A solution and the problem that it is of.
struct CoreSolution {
    std::shared_ptr<const CoreProblem> of;
    Solution solution;
};

/// The same in space.
struct CoreSpaceSolution {
    std::shared_ptr<const CoreSpaceProblem> of;
    SpaceSolution solution;
};

/// What Python has of a family of vehicles.
template <class Family>
struct CoreOf {
    using Problem = CoreProblem;
    using Solution = CoreSolution;
};
template <>
struct CoreOf<planning::Space> {
    using Problem = CoreSpaceProblem;
    using Solution = CoreSpaceSolution;
};

/// A callback of a user with what a search tells; it may be None. Both outlive the search.
[[nodiscard]] std::function<void(const Progress&)> telling(Attendance& attendance, const py::object& on_progress);

/// A problem with its goals in the order in which a plan visits them.
/// @throws InputError if the plan is of another problem: of other targets, from another start or on other control ticks
[[nodiscard]] Problem as_visited(const Problem& problem, const Solution& solution);
/// The same in space. @throws InputError also for a plan of a robot with other joints   @pre there is a plan
[[nodiscard]] SpaceProblem as_visited(const SpaceProblem& problem, const SpaceSolution& solution);

}  // namespace downwash::python
