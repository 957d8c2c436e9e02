#pragma once

#include <optional>
#include <string>

#include "downwash/base/export.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_touch.hpp"

// Where a robot in space touches what a goal names (docs/model.md 7.9).

namespace downwash {

/// Greatest angle between where an end effector points and the way into the surface, at the hover [rad].
inline constexpr double touch_angle_rad = default_angle_tolerance_rad;

/// A touch, or why there is none.
struct FoundTouch {
    std::optional<SpaceTouch> touch;
    std::string reason;  ///< "has no place to touch: ..."; empty with a touch
    /// Without a touch: how far what touches is from where it could wait, at least [m].
    double away_m = 0;
};

/// The touch of a robot that waits at a pose: what touches goes to the nearest point of the obstacle, along the normal
/// of its surface there. The surface has to be flat around it, for the width of what touches and the goal's tolerance.
/// How far the robot waits from where it should is no reason: goal_error() says it.
/// @param hold_s how long the force is held   @param waiting the level robot   @param obstacle that is to be touched,
/// alone, in its nominal place
[[nodiscard]] DOWNWASH_EXPORT FoundTouch find_touch(const SpaceContactGoal& goal, double hold_s,
                                                    const SpaceRobot& robot, const SpacePose& waiting,
                                                    const Scene& obstacle);

/// The middle of what touches, at a pose.
[[nodiscard]] DOWNWASH_EXPORT Vector3 middle_of(const SpaceTouch& touch, const SpaceRobot& robot,
                                                const SpacePose& pose);

}  // namespace downwash
