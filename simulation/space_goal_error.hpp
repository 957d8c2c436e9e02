#pragma once

#include "downwash/base/export.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_touch.hpp"
#include "downwash/simulation/space_world_description.hpp"

// How far a robot in space is from its goals (docs/model.md 7.8).

namespace downwash {

/// How far a pose is from a goal.
struct SpaceGoalError {
    double distance_m = 0;  ///< over what the goal asks for; of a camera, by how much it is too near or too far; 0 of a
                            ///< contact without a place to touch
    double angle_rad = 0;   ///< the greatest of its angles
    double used_share = 0;  ///< the greatest share of a tolerance that is used; see is_met()
    bool is_hidden = false;  ///< something stands between a camera and its target, which is then not met
};

/// Whether the error lies within the goal's tolerances.
[[nodiscard]] inline bool is_met(const SpaceGoalError& error) noexcept {
    return error.used_share <= 1 && !error.is_hidden;
}

/// Whether an error is the lesser one of two alternatives: one that is seen, then the one that uses its tolerances
/// less.
[[nodiscard]] inline bool is_less(const SpaceGoalError& a, const SpaceGoalError& b) noexcept {
    return a.is_hidden != b.is_hidden ? b.is_hidden : a.used_share < b.used_share;
}

/// Something hides a target where it comes nearer than this to the line of sight [m].
inline constexpr double sight_radius_m = 0.001;
/// What is nearer than this to the target along the line of sight belongs to it [m].
inline constexpr double sight_end_m = 0.02;

/// Whether nothing of a scene stands between a camera and what it looks at: no obstacle is nearer than sight_radius_m
/// to the line between both, but for the last sight_end_m.
[[nodiscard]] DOWNWASH_EXPORT bool sees(const Scene& scene, const Vector3& camera_m, const Vector3& target_m);

/// The error of a pose from a goal without alternatives. A contact is met nowhere: see the error from a touch.
/// @param pose in the world   @param scene obstacles in their nominal places
/// @param world whose obstacles stand elsewhere: what a camera looks at goes with them, other goals do not
[[nodiscard]] DOWNWASH_EXPORT SpaceGoalError goal_error(const SpaceGoal& goal, const SpaceRobot& robot,
                                                        const SpacePose& pose, const Scene& scene,
                                                        const SpaceWorld& world = {});

/// The error of a pose from the hover in front of a touch: of the middle of what touches and, of an end effector, of
/// where it points.
[[nodiscard]] DOWNWASH_EXPORT SpaceGoalError goal_error(const SpaceTouch& touch, const SpaceRobot& robot,
                                                        const SpacePose& pose);

}  // namespace downwash
