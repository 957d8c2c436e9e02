#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_gains.hpp"
#include "downwash/simulation/space_robot.hpp"

// How fast the loops of a robot in space should be: as fast as its arm asks for, as slow as its lags (docs/model.md
// 5.13).

namespace downwash {

/// The stiffness that joints need against gravity about a pose [1/s^2]: the greatest p^2 of the directions in which the
/// arm falls as exp(p t), and p^2 / 2 of those in which it swings at p. A law that takes the weight away and holds
/// joints with a stiffness k stays stable while its torques are between p^2 / (p^2 + k) of what they should be, where
/// the arm falls, and p^2 / (p^2 - k), where it swings: half and twice of them. The multirotor floats under the thrust
/// and the torques that carry the robot in this pose. 0 without joints.
/// @param joints_rad one for each joint
[[nodiscard]] DOWNWASH_EXPORT double joint_stiffness_asked_1_s2(const SpaceRobot& robot,
                                                                const std::vector<double>& joints_rad);

/// The greatest over the poses within the limits of the joints, by 512 that are spread evenly over them and all in
/// which every joint is in its middle or at an end.
[[nodiscard]] DOWNWASH_EXPORT double greatest_joint_stiffness_asked_1_s2(const SpaceRobot& robot);

/// The gains of a model inversion for a robot (gains_for()). Where a bandwidth is empty it is as fast as the lags of
/// rotors and controller allow (tilt), or as the arm asks for (joints and observer: the slowest observer, from half of
/// the joints' frequency, that leaves 6 dB and 30 deg to every joint in the examined poses, or what leaves most; where
/// either is given the other does not depend on margins). Of the robot's controller delay and rate count. Joints have
/// no integral beside an observer, which integrates already.
[[nodiscard]] DOWNWASH_EXPORT SpaceInversion designed_inversion(const SpaceRobot& robot, SpaceBandwidths wanted = {});

/// The gains of PX4's cascade for a robot (cascade_gains_for()). Its integrals carry the arm, so their limits are at
/// least half as much again as any pose of the arm asks of roll, pitch and the joints while the robot hovers.
[[nodiscard]] DOWNWASH_EXPORT Px4Cascade designed_cascade(const SpaceRobot& robot, const SpaceBandwidths& wanted);

}  // namespace downwash
