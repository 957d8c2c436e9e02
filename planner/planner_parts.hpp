#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "downwash/planner/braking_parts.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/problem_model.hpp"

// What a planner in flight asks of each family. Both have the same functions.

namespace downwash::planning {

/// A problem that can be planned, and its model.
template <class Family>
struct CheckedOf {
    typename Family::Problem problem;
    std::shared_ptr<const typename Family::FlightModel> model;
};
/// @throws InputError with every error when it cannot be planned
[[nodiscard]] CheckedOf<Plane> checked(const Problem& problem);
[[nodiscard]] CheckedOf<Space> checked(const SpaceProblem& problem);

/// Every reason why a problem cannot be planned.
[[nodiscard]] std::vector<KeyError> errors_of(const Problem& problem);
[[nodiscard]] std::vector<KeyError> errors_of(const SpaceProblem& problem);

/// The same of anything but its start: a vehicle is where it is.
[[nodiscard]] std::vector<KeyError> errors_beside_start(const Problem& problem);
[[nodiscard]] std::vector<KeyError> errors_beside_start(const SpaceProblem& problem);

/// The model of a problem. @param same that of one with the same robot and scene; nullptr: there is none
[[nodiscard]] std::shared_ptr<const FlightModel> model_of(const Problem& problem,
                                                          const std::shared_ptr<const FlightModel>& same);
[[nodiscard]] std::shared_ptr<const SpaceProblemModel> model_of(const SpaceProblem& problem,
                                                                const std::shared_ptr<const SpaceProblemModel>& same);

/// @pre the problem is the model's
[[nodiscard]] Solution solved(const Problem& problem, const std::shared_ptr<const FlightModel>& model,
                              const SolveOptions& options);
[[nodiscard]] SpaceSearchResult solved(const SpaceProblem& problem,
                                       const std::shared_ptr<const SpaceProblemModel>& model,
                                       const SpaceSolveOptions& options);

/// Brings goals into the order of a plan through all of them; a budget is dropped.
void take_order(Problem& problem, const Solution& solution);
void take_order(SpaceProblem& problem, const SpaceSearchResult& solution);

/// Leaves nothing to be reached but a goal.
void set_goal(Problem& problem, const Goal& goal);
void set_goal(SpaceProblem& problem, const SpaceGoal& goal);

/// The problem with what its goals take from its scene.
[[nodiscard]] Problem with_places(Problem problem);
[[nodiscard]] inline SpaceProblem with_places(SpaceProblem problem) {
    return problem;
}

/// Drops goals whose hovers are over by a tick of a plan, but for the last one.
void drop_visited(Problem& problem, const FlightModel& model, const Plan& plan, std::int64_t tick);
void drop_visited(SpaceProblem& problem, const SpaceProblemModel& model, const SpacePlan& plan, std::int64_t tick);

/// Whether motion and reference of a start are finite.
[[nodiscard]] bool is_finite(const Start& start);
[[nodiscard]] bool is_finite(const SpaceStart& start);

/// A plan of the problem flown with direct aerodynamics.
[[nodiscard]] Execution executed(const Problem& problem, const FlightModel& model, const Plan& plan);
[[nodiscard]] SpaceFlight executed(const SpaceProblem& problem, const SpaceProblemModel& model, const SpacePlan& plan);

/// Whether a plan of the problem meets all goals in every one of some worlds. @throws WorkStopped
[[nodiscard]] bool survives(const Problem& problem, const PlannerModelOf<Plane>& model, int threads, const Plan& plan,
                            std::span<const FlownWorld> worlds, const StopCondition& is_over);
[[nodiscard]] bool survives(const SpaceProblem& problem, const PlannerModelOf<Space>& model, int threads,
                            const SpacePlan& plan, std::span<const SpaceWorld> worlds, const StopCondition& is_over);

/// The map of a scene after changes that it does not know yet.
/// @param map of the scene before; nullptr: there is none   @param unmapped what has changed since
[[nodiscard]] std::shared_ptr<const AeroMap> map_after(const Problem& problem, const FlightModel& model,
                                                       const std::shared_ptr<const AeroMap>& map,
                                                       const std::vector<BoundingBox>& unmapped,
                                                       const std::filesystem::path& cache);
[[nodiscard]] std::shared_ptr<const SurfaceVolumes> map_after(const SpaceProblem& problem,
                                                              const SpaceProblemModel& model,
                                                              const std::shared_ptr<const SurfaceVolumes>& volumes,
                                                              const std::vector<BoundingBox>& unmapped,
                                                              const std::filesystem::path& cache);

/// A map around some places of the vehicle: the one that is there, if nothing has changed over or under them.
[[nodiscard]] BrakingPartsOf<Plane>::MapAround map_around(const Problem& problem, const FlightModel& model,
                                                          const std::shared_ptr<const AeroMap>& map,
                                                          const std::vector<BoundingBox>& unmapped);
[[nodiscard]] BrakingPartsOf<Space>::MapAround map_around(const SpaceProblem& problem, const SpaceProblemModel& model,
                                                          const std::shared_ptr<const SurfaceVolumes>& volumes,
                                                          const std::vector<BoundingBox>& unmapped);

/// Keeps what is new in a map.
void keep(const std::filesystem::path& cache, const AeroMap& map);
void keep(const std::filesystem::path& cache, const SurfaceVolumes& volumes);

}  // namespace downwash::planning
