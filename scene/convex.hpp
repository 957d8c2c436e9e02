#pragma once

// Convex solids as sums of simple parts, and the distance between two of them. Private: not installed.
// Triangles are solids of no thickness.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash {

/// How a solid's own frame is turned in the frame it is placed in.
struct Placement {
    Matrix3 rotation{};    ///< own frame to the outer one; its columns are the own axes seen from outside
    Vector3 axis_world{};  ///< unit axis of a cylinder seen from outside; the own z axis of other shapes
};

/// All points center + (segments: sum of s_i half_axes[i], |s_i| <= 1) + (a point of the disc) + (a point of the ball).
/// A box is three segments, a cylinder one segment and a disc, a capsule one segment and a ball, a sphere a ball. In a
/// triangle, center + half_axes[i] are the corners instead, and center is that of its bounding box.
/// Every vector is in one frame, which the owner names.
struct Convex {
    Vector3 center_m{};
    int segment_count = 0;
    bool is_triangle = false;
    std::array<Vector3, 3> half_axes_m{};
    Vector3 disc_normal{0, 0, 1};  ///< unit vector
    double disc_radius_m = 0;
    double ball_radius_m = 0;
};

Placement placement_of(const Primitive& shape, const Matrix3& rotation) noexcept;

/// The solid `shape` with its own frame placed at `center_m` in the frame of `placement`.
Convex convex_of(const Primitive& shape, const Vector3& center_m, const Placement& placement);

/// A solid of a robot in the frame of its body.
Convex convex_of(const SpaceBodyShape& solid);

/// A solid whose directions are turned and whose centre is moved. @param turn turns a vector
template <class Turn>
Convex placed(const Convex& own, const Vector3& center_m, const Turn& turn) {
    Convex convex = own;
    convex.center_m = center_m;
    for (std::size_t i = 0; i < static_cast<std::size_t>(own.segment_count); ++i) {
        convex.half_axes_m[i] = turn(own.half_axes_m[i]);
    }
    convex.disc_normal = turn(own.disc_normal);
    return convex;
}

/// Half the extents along the axes of the frame [m]: the tight bounding box is center +- these.
Vector3 half_extents_m(const Convex& convex) noexcept;

inline BoundingBox bounds_of(const Convex& convex) noexcept {
    const Vector3 half = half_extents_m(convex);
    return {convex.center_m - half, convex.center_m + half};
}

/// Distance between two solids [m] to 1e-8, mostly to 1e-10, never above the truth but for rounding; <= 0 on contact
/// (not a depth). Once the distance is certain to be at least `enough_m`, any certain lower bound of that size may be
/// returned.
double distance_m(const Convex& a, const Convex& b, double enough_m) noexcept;

/// Solids nearer to each other than this, which is how exactly distances are known, are in contact [m].
inline constexpr double contact_m = 1e-8;

/// True when the distance is below `margin_m` (>= contact_m) or the solids touch; a distance at most 1e-8 m above it
/// may count as below. Sooner than the distance itself.
bool is_nearer_than(const Convex& a, const Convex& b, double margin_m) noexcept;

/// The largest of the gaps between two bounding boxes along the three axes [m], a lower bound of the distance between
/// what they hold; negative when they overlap.
inline double gap_m(const BoundingBox& a, const BoundingBox& b) noexcept {
    double gap = a.low_m[0] - b.high_m[0];
    const auto widen = [&gap](double other) { gap = other > gap ? other : gap; };
    widen(b.low_m[0] - a.high_m[0]);
    widen(a.low_m[1] - b.high_m[1]);
    widen(b.low_m[1] - a.high_m[1]);
    widen(a.low_m[2] - b.high_m[2]);
    widen(b.low_m[2] - a.high_m[2]);
    return gap;
}

/// The distance of two bounding boxes [m], 0 when they meet: a better lower bound, at the price of a root.
inline double box_distance_m(const BoundingBox& a, const BoundingBox& b) noexcept {
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double gap = std::max({0.0, a.low_m[k] - b.high_m[k], b.low_m[k] - a.high_m[k]});
        squared += gap * gap;
    }
    return std::sqrt(squared);
}

}  // namespace downwash
