#pragma once

// Private: not installed.

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Twice the area of the triangle a, b, c; positive when they run counter-clockwise.
[[nodiscard]] inline double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x_m - a.x_m) * (c.z_m - a.z_m) - (b.z_m - a.z_m) * (c.x_m - a.x_m);
}

/// The corners of the convex hull, counter-clockwise; fewer than three when the points lie on a line.
[[nodiscard]] Ring convex_hull(std::vector<PlanePoint> points);

/// Joins polygons that share whole edges, such as the sections of an octree's cubes: shared edges vanish, and so do
/// corners on straight lines. The result is outlines, counter-clockwise, and the holes in them, clockwise.
/// @param rings counter-clockwise, none over another; corners within 1e-7 m of each other count as one
[[nodiscard]] DOWNWASH_EXPORT std::vector<Ring> joined_rings(const std::vector<Ring>& rings);

}  // namespace downwash
