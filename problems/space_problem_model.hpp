#pragma once

#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/space_goal_rule.hpp"

namespace downwash {

/// The vehicle at the start of a problem, for a robot with any number of joints.
[[nodiscard]] DOWNWASH_EXPORT SpaceMotion start_motion(const SpaceStart& start) noexcept;

/// Whether nothing moves at the start and the vehicle is level, so that it may have hovered there for long: none that
/// is in a flight already.
[[nodiscard]] DOWNWASH_EXPORT bool is_at_rest(const SpaceStart& start) noexcept;

/// The reference at a start: where the vehicle is, as it moves, or the one that it follows.
[[nodiscard]] DOWNWASH_EXPORT SpacePoint reference_at(const SpaceStart& start) noexcept;

/// How to execute a plan of a problem in space.
struct SpaceExecutionSettings {
    bool aero = true;  ///< false: as if there were no surface effects, and no flyable area
    /// Empty: the nominal one. In a world a vehicle that begins at rest at the problem's start has hovered there.
    std::optional<SpaceWorld> world;
    const SpaceGoalRule* goals = nullptr;  ///< in place of the problem's; nullptr: those
    bool measures_clearance = true;        ///< false: rows have an infinite one, and the flight takes less time
    std::optional<AnySpaceState> start;    ///< the vehicle, in place of that at the problem's start
    StopCondition is_over;
};

/// A problem in space and all that its flights need and never change. Safe to share between threads.
class DOWNWASH_EXPORT SpaceProblemModel {
 public:
    /// @pre space_problem_errors(problem) is empty
    explicit SpaceProblemModel(SpaceProblem problem);
    /// Shares scene and shape of the robot with another model: that takes no time.
    /// @pre its problem has the same obstacles, robot and collision checker
    SpaceProblemModel(SpaceProblem problem, const SpaceProblemModel& other);

    [[nodiscard]] const SpaceProblem& problem() const noexcept { return problem_; }
    [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
    [[nodiscard]] const std::shared_ptr<const Scene>& shared_scene() const noexcept { return scene_; }
    /// Collisions and clearances.
    [[nodiscard]] const SpaceChecker& collisions() const noexcept { return checker_; }

    /// Flies a plan from the start of the problem to the end of the hover for its last goal, with surface effects
    /// evaluated directly. A flight that takes more than the problem's energy budget ends over_budget.
    /// @throws InputError if a model of surface effects cannot act in space, or the robot has more joints than this
    /// library was built for; WorkStopped when `is_over` says so
    /// @pre the plan has at least one knot, the robot's number of joints and its tick
    [[nodiscard]] SpaceFlight execute(const SpacePlan& plan, const SpaceExecutionSettings& settings = {}) const;
    /// The same to the last knot of a plan that need not come to any goal, in the nominal world.
    [[nodiscard]] SpaceFlight execute_part(const SpacePlan& plan) const;

    /// The goals of the problem, as flights meet them.
    [[nodiscard]] const SpaceGoalRule& goals() const noexcept { return goals_; }

 private:
    [[nodiscard]] SpaceFlight fly(const SpacePlan& plan, const SpaceExecutionSettings& settings,
                                  const SpaceGoalRule* goals) const;

    SpaceProblem problem_;
    std::shared_ptr<const Scene> scene_;
    SpaceChecker checker_;
    SpaceGoalRule goals_;
};

/// The vehicle at a start of a problem, in the nominal world. @pre start_errors() finds nothing in it
[[nodiscard]] DOWNWASH_EXPORT AnySpaceState start_state(const SpaceProblemModel& model, const SpaceStart& start);

/// A vehicle in the middle of a flight, as a start. What it saw a delay ago is not part of it: at a start it has always
/// been as it is.
/// @param reference that it follows at this moment
[[nodiscard]] DOWNWASH_EXPORT SpaceStart start_of(const SpaceProblemModel& model, const AnySpaceState& state,
                                                  const SpacePoint& reference);

}  // namespace downwash
