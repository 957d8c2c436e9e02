#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/input_facts.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/space_flight.hpp"

// solution.json in space: the keys and the schema of the plane (solution_file.hpp), with the axes of space.

namespace downwash {

/// A plan in space, its flight, and the settings that it was asked with.
struct SpaceSolution {
    Status status = Status::solved;
    bool interrupted = false;
    Variant variant = Variant::mp_arm_ada;
    std::string algorithm;
    CostFunction objective;
    std::uint32_t seed = 1;
    int threads = 1;
    int joints = 0;                                   ///< of the robot
    std::shared_ptr<const SpaceSearchResult> search;  ///< that found the plan; nullptr: it was given
    std::optional<SpacePlan> plan;
    std::optional<SpaceFlight> execution;           ///< the whole plan flown from the start of the problem
    bool aero = true;                               ///< whether surfaces acted on the rotors in that flight
    std::optional<VisitOrder> order;                ///< of the targets of a problem; empty: none, or the plan shows it
    std::optional<ExecutionWorld> execution_world;  ///< empty: the nominal one
    std::optional<SafeStopsOf<planning::Space>> safe_stops;  ///< along the plan; empty if nobody looked for them
    std::optional<Replanned> replanned;                      ///< empty: the plan begins on its own
};

/// What a search has found for a problem, with the settings of the problem.
[[nodiscard]] DOWNWASH_EXPORT SpaceSolution solution_of(const SpaceProblem& problem,
                                                        std::shared_ptr<const SpaceSearchResult> search, int threads);

/// How a solution names its problem; see ProblemReference.
struct SpaceProblemReference {
    std::string name, file, sha256;
    std::vector<LocatedError> warnings = {};
    std::optional<SpaceInputFacts> inputs = {};
};

/// The greatest error of all goals of a flight [m].
[[nodiscard]] DOWNWASH_EXPORT double worst_goal_error_m(const SpaceFlight& flight) noexcept;

/// The text of solution.json: see the solution_json() of a plan in the plane.
[[nodiscard]] DOWNWASH_EXPORT std::string solution_json(const SpaceSolution& solution,
                                                        const SpaceProblemReference& problem,
                                                        const FileDigests& files = {});

/// Reads a plan in space back, to fly it for `problem`. The execution stays empty. A plan written by hand needs
/// `schema` and `plan.reference` alone; a knot without rates and accelerations rests. The rest is taken from the
/// problem's settings.
/// @param on_warning is told where the reference breaks the problem's `motion`, its bounds or the limits of a joint,
/// and whether it ends in motion
/// @throws ProblemFileError with every error: no solution file, no plan in it, a knot off the grid of control ticks or
/// with other axes than the robot has, a reference that starts elsewhere than the problem does, waypoints that disagree
/// with it
[[nodiscard]] DOWNWASH_EXPORT SpaceSolution
read_solution(const std::string& path, const SpaceProblem& problem,
              const std::function<void(const LocatedError&)>& on_warning = {});

}  // namespace downwash
