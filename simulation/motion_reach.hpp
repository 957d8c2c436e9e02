#pragma once

#include "downwash/base/lane_math.hpp"

namespace downwash::simulation {

/// How far from the multirotor's centre of mass the points of a robot are [m].
struct MotionReach {
    double body_m;   ///< the multirotor's farthest point
    double joint_m;  ///< the joint
    double arm_m;    ///< the arm's farthest point, from the joint
};

/// A bound on how far any point of the robot moves between two poses (x, z, pitch, arm) whose coordinates change evenly
/// [m]. One template over the lane type.
template <class T>
T motion_m(const MotionReach& reach, const T from[4], const T to[4]) {
    const T dx = to[0] - from[0];
    const T dz = to[1] - from[1];
    const T pitch = lane::abs(to[2] - from[2]);
    const T arm = lane::abs(to[2] + to[3] - (from[2] + from[3]));
    return lane::sqrt(dx * dx + dz * dz) +
           lane::max(T(reach.body_m) * pitch, T(reach.joint_m) * pitch + T(reach.arm_m) * arm);
}

}  // namespace downwash::simulation
