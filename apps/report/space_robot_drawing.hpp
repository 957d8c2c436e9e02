#pragma once

// Private: not installed.

#include <vector>

#include "downwash/report/picture.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// The lines of a robot in space at a pose, as it is seen from a direction: its bodies, the discs of its rotors, and
/// its arm; links without a body are lines from joint to joint.
/// @param view from the axes of the world to across, away and up; see obstacle_outline.hpp
[[nodiscard]] std::vector<Ring> robot_lines(const SpaceRobot& robot, const SpacePose& pose, const Matrix3& view);

/// Where its end effector is, in the world.
[[nodiscard]] Vector3 end_effector_at(const SpaceRobot& robot, const SpacePose& pose);

}  // namespace downwash
