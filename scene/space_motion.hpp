#pragma once

#include <array>
#include <cstddef>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/space_pose.hpp"

// How far points of a robot in space can move between two poses. One template over the lane type.

namespace downwash {

/// An arm that hovers at a limit swings about it. The solids that may touch are those that may up to this angle beyond
/// the limits of the joints [rad].
inline constexpr double joint_swing_rad = 0.1;

/// How far the points of a robot are from what turns them, at most, at any joint angles [m].
struct SpaceReach {
    /// The bodies of the multirotor or of one link.
    struct Body {
        bool can_touch = false;                   ///< whether it has a solid
        double center_m = 0;                      ///< from the multirotor's centre of mass
        std::array<double, max_links> joint_m{};  ///< from the axis of each joint that moves it
    };
    std::array<Body, max_links + 1> bodies{};  ///< the multirotor, then the links
    std::size_t links = 0;

    /// No point of the robot is farther from the multirotor's centre of mass [m].
    [[nodiscard]] double robot_m() const noexcept {
        double most_m = 0;
        for (std::size_t i = 0; i <= links; ++i) {
            most_m = bodies[i].center_m > most_m ? bodies[i].center_m : most_m;
        }
        return most_m;
    }
};

/// By how much the coordinates of a robot change; nothing is below 0.
template <class T>
struct SpaceChange {
    T shift_m = T(0);   ///< distance between both positions
    T turn_rad = T(0);  ///< angle between both attitudes, at most pi
    T joints_rad[max_links]{};

    /// The change of half of the way.
    [[nodiscard]] SpaceChange half() const noexcept {
        SpaceChange all = *this;
        all.shift_m = T(0.5) * shift_m;
        all.turn_rad = T(0.5) * turn_rad;
        for (T& joint_rad : all.joints_rad) {
            joint_rad = T(0.5) * joint_rad;
        }
        return all;
    }
};

/// The angle between two attitudes, the shorter way [rad]. @param a,b quaternions of length 1
template <class T>
[[nodiscard]] T turn_between_rad(const T a[4], const T b[4]) {
    T apart(0), together(0);  // as vectors of length 1 they are a quarter of the angle or of its supplement apart
    for (int i = 0; i < 4; ++i) {
        apart = apart + (a[i] - b[i]) * (a[i] - b[i]);
        together = together + (a[i] + b[i]) * (a[i] + b[i]);
    }
    return T(4) * lane::atan2(lane::sqrt(lane::min(apart, together)), lane::sqrt(lane::max(apart, together)));
}

/// A bound on how far any point of a body moves relative to another body of the same arm, or to the multirotor, while
/// coordinates change that much [m]: sum of l |dq| over the joints between them.
/// @param from,body numbers in SpaceReach::bodies, from <= body
template <class T>
[[nodiscard]] T joint_motion_m(const SpaceReach& reach, std::size_t from, std::size_t body,
                               const SpaceChange<T>& change) {
    T sum_m(0);
    for (std::size_t joint = from; joint < body; ++joint) {
        sum_m = sum_m + T(reach.bodies[body].joint_m[joint]) * change.joints_rad[joint];
    }
    return sum_m;
}

/// A bound on how far any point of a body moves in the world while coordinates change that much [m]. A pose after a
/// share of the way is within that share of it.
template <class T>
[[nodiscard]] T motion_m(const SpaceReach& reach, std::size_t body, const SpaceChange<T>& change) {
    return change.shift_m + T(reach.bodies[body].center_m) * change.turn_rad + joint_motion_m(reach, 0, body, change);
}

/// A bound on how far any point of the robot moves in the world while coordinates change that much [m].
template <class T>
[[nodiscard]] T motion_m(const SpaceReach& reach, const SpaceChange<T>& change) {
    T most_m(0);
    for (std::size_t body = 0; body <= reach.links; ++body) {
        if (reach.bodies[body].can_touch) {
            most_m = lane::max(most_m, motion_m(reach, body, change));
        }
    }
    return most_m;
}

/// A bound on how far any points of the robot move relative to each other while coordinates change that much [m].
template <class T>
[[nodiscard]] T joint_motion_m(const SpaceReach& reach, const SpaceChange<T>& change) {
    T most_m(0);
    for (std::size_t body = 1; body <= reach.links; ++body) {
        if (reach.bodies[body].can_touch) {
            most_m = lane::max(most_m, joint_motion_m(reach, 0, body, change));
        }
    }
    return most_m;
}

/// By how much coordinates change between two poses.
[[nodiscard]] inline SpaceChange<double> change_between(const SpacePose& from, const SpacePose& to) noexcept {
    SpaceChange<double> change;
    const Vector3 shift_m = to.position_m - from.position_m;
    change.shift_m = lane::sqrt(dot(shift_m, shift_m));
    change.turn_rad = turn_between_rad(normalised(from.attitude).data(), normalised(to.attitude).data());
    for (std::size_t i = 0; i < max_links; ++i) {
        change.joints_rad[i] = lane::abs(to.joints_rad[i] - from.joints_rad[i]);
    }
    return change;
}

}  // namespace downwash
