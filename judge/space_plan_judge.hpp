#pragma once

#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/judge/space_judged_flight.hpp"
#include "downwash/judge/world_runs.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/simulation/space_world_description.hpp"

namespace downwash::judge {

/// Flies plans of a problem in space and says how they end, as PlanJudge does in the plane. Safe to share between
/// threads.
class DOWNWASH_EXPORT SpacePlanJudge {
 public:
    /// @throws InputError if the air has a setting that the judge does not know: see SpaceJudge
    /// @pre space_problem_errors(problem) is empty
    explicit SpacePlanJudge(const SpaceProblem& problem);
    ~SpacePlanJudge();
    SpacePlanJudge(const SpacePlanJudge&) = delete;
    SpacePlanJudge& operator=(const SpacePlanJudge&) = delete;

    [[nodiscard]] const SpaceProblem& problem() const noexcept;

    /// Flies a plan from the start of the problem to the end of the hover for its last goal.
    /// @param aero false: surfaces have no effect on the rotors   @param world empty: everything is nominal
    /// @pre the plan has a knot, the first at tick 0, the robot's joints and its tick
    [[nodiscard]] SpaceJudgedFlight fly(const SpacePlan& plan, bool aero = true,
                                        const std::optional<SpaceWorld>& world = {}) const;

 private:
    struct Shared;
    std::unique_ptr<const Shared> shared_;
};

/// Flies a plan in worlds of the problem's uncertainty: see the fly_in_worlds() of the plane. There is no fan.
/// @pre judge.problem().uncertainty
[[nodiscard]] DOWNWASH_EXPORT std::optional<WorldRuns> fly_in_worlds(const SpacePlanJudge& judge, const SpacePlan& plan,
                                                                     const WorldRunOptions& options);

}  // namespace downwash::judge
