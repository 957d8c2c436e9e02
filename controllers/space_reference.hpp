#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"

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

/// The reference that rests where a point is.
[[nodiscard]] inline SpacePoint rest_at(const SpacePoint& point) noexcept {
    SpacePoint rest;
    std::copy_n(point.position, space_axes<max_joints>, rest.position);
    return rest;
}

/// Whether a reference point neither moves nor accelerates.
[[nodiscard]] inline bool is_at_rest(const SpacePoint& point) noexcept {
    return point == rest_at(point);
}

class SpaceSegment;  // space_segment.hpp

/// A point that a reference passes at a control tick, counted from the start of the flight. Neighbouring knots span a
/// quintic per axis.
struct SpaceKnot {
    std::int64_t tick = 0;
    SpacePoint point;
};

/// A timed reference in space: knots on control ticks, with a SpaceSegment between neighbouring knots.
struct DOWNWASH_EXPORT SpacePlan {
    std::vector<SpaceKnot> reference;  ///< the first at tick 0, ticks rising
    double tick_s = 0;                 ///< length of a control tick [s]
    int joints = 0;                    ///< number of joints, 0 to max_joints

    [[nodiscard]] double duration_s() const {
        return reference.empty() ? 0 : static_cast<double>(reference.back().tick) * tick_s;
    }

    /// The reference at a tick: before the first knot that of the first, after the last knot that of the last.
    /// @pre there is a knot
    [[nodiscard]] SpacePoint at(std::int64_t tick) const;
    /// The reference at a time, which need not be a tick [s]; at rest after the last knot. @pre there is a knot
    [[nodiscard]] SpacePoint at_time(double t_s) const;

    /// The piece of the reference that ends at a knot other than the first.
    [[nodiscard]] SpaceSegment segment_to(std::size_t knot) const;
    /// All pieces in their order, one fewer than knots.
    [[nodiscard]] std::vector<SpaceSegment> segments() const;

    /// What is left from a tick on, as a plan whose tick 0 that is. @pre there is a knot
    [[nodiscard]] SpacePlan rest_after(std::int64_t tick) const;
    /// The beginning of the plan, so many ticks long; a plan that is over earlier stays at its last point.
    /// @pre there is a knot
    [[nodiscard]] SpacePlan beginning(std::int64_t ticks) const;
    /// The same reference with knots at most so many ticks apart. @pre there is a knot; max_ticks is at least 1
    [[nodiscard]] SpacePlan divided(std::int64_t max_ticks) const;
    /// This plan and, from its last knot on, another one that begins there.
    [[nodiscard]] SpacePlan followed_by(const SpacePlan& next) const;
    /// This plan and a stay at its last point. @pre there is a knot
    [[nodiscard]] SpacePlan held_for(std::int64_t ticks) const;
};

}  // namespace downwash
