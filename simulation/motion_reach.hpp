#pragma once

#include "downwash/base/lane_math.hpp"

namespace downwash::simulation {

/// How far from the multirotor's centre of mass the points of a robot are [m].
struct MotionReach {
    double body_m;   ///< those of the multirotor, at most
    double joint_m;  ///< the joint
    double arm_m;    ///< the arm's, from the joint, at most
};

/// No point of the robot moves farther between two poses (x, z, pitch, arm) whose coordinates all change evenly [m].
/// One template over the lane type.
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
