#pragma once

#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_goal_rule.hpp"

namespace downwash {

/// The vehicle at the start of a problem, for a robot with any number of joints.
[[nodiscard]] DOWNWASH_EXPORT SpaceMotion start_motion(const SpaceStart& start) noexcept;

/// Whether nothing moves at the start and the vehicle is level, so that it may have hovered there for long.
[[nodiscard]] DOWNWASH_EXPORT bool is_at_rest(const SpaceStart& start) noexcept;

/// How to execute a plan of a problem in space.
struct SpaceExecutionSettings {
    bool aero = true;  ///< false: as if there were no surface effects, and no flyable area
    /// Empty: the nominal one. In a world a vehicle that begins at rest at the problem's start has hovered there.
    std::optional<SpaceWorld> world;
    const SpaceGoalRule* goals = nullptr;  ///< in place of the problem's; nullptr: those
    std::optional<SpaceMotion> start;      ///< in place of the problem's, the controller at rest; empty: that
    StopCondition is_over;
};

/// A problem in space and all that its flights need and never change. Safe to share between threads.
class DOWNWASH_EXPORT SpaceProblemModel {
 public:
    /// @pre space_problem_errors(problem) is empty
    explicit SpaceProblemModel(SpaceProblem problem);

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

 private:
    SpaceProblem problem_;
    std::shared_ptr<const Scene> scene_;
    SpaceChecker checker_;
    SpaceGoalRule goals_;
};

}  // namespace downwash
