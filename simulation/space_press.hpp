#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_touch.hpp"

namespace downwash {

/// What a robot lacks to press on a surface with touch.force_n, by the statics of the level robot: thrust against its
/// weight and the force, the tilt that this takes, the thrust of each rotor, or the torque of a joint. "takes 502 N of
/// thrust, and its rotors give 214 N at most"; empty if it lacks nothing.
/// @param waiting the level robot in front of the surface
[[nodiscard]] DOWNWASH_EXPORT std::string lacks_to_press(const SpaceRobot& robot, const SpacePose& waiting,
                                                         const SpaceTouch& touch);

}  // namespace downwash
