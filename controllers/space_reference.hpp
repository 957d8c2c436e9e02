#pragma once

#include <cstdint>
#include <vector>

// The reference of a vehicle in space: x, y, z [m], yaw [rad] and the joints of its arm [rad], in this order. One
// template over the lane type.

namespace downwash {

/// The greatest number of joints of an arm in space.
inline constexpr int max_joints = 6;

/// Number of axes of the reference of a vehicle with n joints.
template <int n>
inline constexpr int space_axes = 4 + n;

/// Indices of the axes.
namespace space {
inline constexpr int x = 0, y = 1, z = 2, yaw = 3, first_joint = 4;
}  // namespace space

/// Where vehicle and arm should be at one instant: the coordinate of each axis with its first and second time
/// derivative. Angles are unwrapped.
template <class T, int n>
struct BasicSpacePoint {
    T position[space_axes<n>]{};
    T velocity[space_axes<n>]{};
    T acceleration[space_axes<n>]{};

    friend bool operator==(const BasicSpacePoint&, const BasicSpacePoint&) = default;
};

/// The reference point of a single vehicle with any number of joints: those that it lacks stay at zero.
using SpacePoint = BasicSpacePoint<double, max_joints>;

/// A point that a reference passes at a control tick, counted from the start of the flight. Neighbouring knots span a
/// quintic per axis.
struct SpaceKnot {
    std::int64_t tick = 0;
    SpacePoint point;
};

/// A timed reference in space.
struct SpacePlan {
    std::vector<SpaceKnot> reference;  ///< the first at tick 0, ticks rising
    double tick_s = 0;                 ///< length of a control tick [s]
    int joints = 0;                    ///< number of joints, 0 to max_joints
};

}  // namespace downwash
