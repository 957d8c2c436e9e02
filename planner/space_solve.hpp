#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/found.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/space_problem_model.hpp"

namespace downwash {

/// How a program takes part in a search in space.
using SpaceSolveOptions = SolveOptionsOf<planning::Space>;

/// What a search in space has found, and how it went.
struct SpaceSearchResult : FoundOf<planning::Space> {
    bool interrupted = false;  ///< ended by the stop token
    std::uint32_t seed = 1;    ///< of the search
    SearchRecord planning;
    /// Volumes of the problem, for SpaceSolveOptions::map of another one with the same scene; empty: none.
    std::shared_ptr<const SurfaceVolumes> map;
};

/// What of a sound problem in space cannot be planned yet: narrow passages, rules of yaw by OMPL's planners. Keys are
/// key paths of a problem file. Empty if it can be planned.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> space_planning_errors(const SpaceProblem& problem);

/// Whether any surface changes what the rotors of a problem do. If none does, no flight needs volumes.
[[nodiscard]] bool has_surface_effects(const SpaceProblem& problem);

/// The volumes of surface effects wherever the vehicle of a problem can be. They fill themselves as flights ask.
/// @param cache folder of a MapCache; empty: none
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const SurfaceVolumes> make_volumes(
    const SpaceProblemModel& model, const std::filesystem::path& cache = {});

/// Plans, and flies the plan with direct aerodynamics, hold included; see solve() of the plane. The same search finds
/// plans of both families.
/// @throws InputError when the vehicle cannot hover at its start in some world of the search
/// @pre space_planning_errors(model.problem()) is empty
[[nodiscard]] DOWNWASH_EXPORT SpaceSearchResult solve(const std::shared_ptr<const SpaceProblemModel>& model,
                                                      const SpaceSolveOptions& options = {});

/// Flies a plan through all goals of a problem in worlds, from its start, one lane each.
/// @param volumes of the problem; nullptr: no surface acts
/// @return one sample for each world, in their order and numbered from 1   @throws WorkStopped
[[nodiscard]] DOWNWASH_EXPORT std::vector<WorldSample> fly_in_worlds(
    const std::shared_ptr<const SpaceProblemModel>& model, const std::shared_ptr<const SurfaceVolumes>& volumes,
    const SpacePlan& plan, std::span<const SpaceWorld> worlds, const StopCondition& is_over, int threads = 1);

}  // namespace downwash
