#pragma once

#include <memory>
#include <optional>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/base/space_bounds.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_robot.hpp"

// Whether a level robot can hover at a goal in space, and why not (docs/model.md 7.10).

namespace downwash {

/// Why a robot does not reach a goal, for messages.
struct SpaceGoalObjection {
    std::string key;     ///< of the goal's kind that it is about: "direction"; empty: the goal as a whole
    std::string reason;  ///< what is wrong, and the nearest goal that is not: "points 80 degrees above the level: ..."
};

/// A goal without alternatives that asks the end effector to point where the joints cannot turn it within their limits,
/// whatever its yaw and the tolerances of the goal. Nothing of goals that ask for no direction, and of contacts.
/// @pre space_robot_errors(robot) is empty, and the values of the goal are sound
[[nodiscard]] DOWNWASH_EXPORT std::optional<SpaceGoalObjection> aim_objection(const SpaceRobot& robot,
                                                                              const SpaceGoal& goal);

/// Whether some configurations that meet a goal without alternatives are free.
struct SpaceGoalReach {
    SpaceGoalSample tries;  ///< its place is free, and where the robot can hover
    /// Without a place. It is no proof: other configurations may be free. That of aim_objection() is one; then nothing
    /// was tried.
    std::optional<SpaceGoalObjection> objection;
};

/// Tries up to 400 configurations, half of them at the goal itself and half anywhere within the share of its tolerances
/// that plans may use; always the same ones.
/// @param scene obstacles in their nominal places   @param checker of the robot in that scene
/// @param margin_m that the robot keeps from obstacles, >= 0
/// @pre as aim_objection()
[[nodiscard]] DOWNWASH_EXPORT SpaceGoalReach goal_reach(const SpaceRobot& robot, const SpaceBounds& bounds,
                                                        const std::shared_ptr<const Scene>& scene,
                                                        const SpaceChecker& checker, double margin_m,
                                                        const SpaceGoal& goal);

}  // namespace downwash
