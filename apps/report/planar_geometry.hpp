#pragma once

// Private: not installed.

#include <array>
#include <cstdint>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Twice the area of the triangle a, b, c; positive when they run counter-clockwise.
[[nodiscard]] inline double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x_m - a.x_m) * (c.z_m - a.z_m) - (b.z_m - a.z_m) * (c.x_m - a.x_m);
}

/// The least box around lines; its low sides are above its high ones where there are none.
[[nodiscard]] Bounds box_of(const std::vector<Ring>& lines);

/// The corners of the convex hull, counter-clockwise; fewer than three when the points lie on a line.
[[nodiscard]] Ring convex_hull(std::vector<PlanePoint> points);

/// Joins polygons that share whole edges, such as the sections of an octree's cubes: shared edges vanish, and so do
/// corners on straight lines. The result is outlines, counter-clockwise, and the holes in them, clockwise.
/// @param rings counter-clockwise, none over another; corners within 1e-7 m of each other count as one
[[nodiscard]] DOWNWASH_EXPORT std::vector<Ring> joined_rings(const std::vector<Ring>& rings);

/// The part of a polygon within an extent. Every point inside the extent keeps its winding number, also of rings that
/// cross themselves or are holes. Parts that the extent separates stay connected along its border.
[[nodiscard]] DOWNWASH_EXPORT Ring clipped_ring(const Ring& ring, const Bounds& extent);

/// The pieces of a line within an extent. @param is_closed whether the line returns to its first point
[[nodiscard]] DOWNWASH_EXPORT std::vector<Ring> clipped_line(const Ring& line, bool is_closed, const Bounds& extent);

/// The section of a surface with a plane.
struct MeshSection {
    std::vector<Ring> rings;  ///< closed
    std::vector<Ring> lines;  ///< open
};

/// The section of triangles with the plane lateral = 0; corners are (x, lateral, z). Vertices with equal coordinates
/// are one. Around solid parts of a closed surface whose corners run counter-clockwise seen from outside, rings run
/// counter-clockwise; around holes, clockwise.
[[nodiscard]] MeshSection mesh_section(const std::vector<Vector3>& vertices_m,
                                       const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace downwash
