#pragma once

// Private to scene/: one triangle of a surface, placed in the world.

#include <array>

#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/convex.hpp"

namespace downwash {

/// The corners, counter-clockwise seen from outside [m].
using Triangle = std::array<Vector3, 3>;

/// The triangle as a solid of no thickness.
[[nodiscard]] Convex convex_of(const Triangle& triangle) noexcept;

[[nodiscard]] BoundingBox bounds_of(const Triangle& triangle) noexcept;

/// Twice the area times the unit normal.
[[nodiscard]] Vector3 normal_of(const Triangle& triangle) noexcept;

/// Whether it is seen from above at all: false for upright triangles and those without area.
[[nodiscard]] bool has_shadow(const Triangle& triangle) noexcept;

/// Whether its corners lie at one height.
[[nodiscard]] bool is_level(const Triangle& triangle) noexcept;

/// Where the vertical line through (x, y) meets the triangle: one height, or nowhere. Nowhere for upright triangles.
[[nodiscard]] Interval vertical_extent(const Triangle& triangle, double x_m, double y_m) noexcept;

/// See Scene::shadow_on_line; nowhere for upright triangles.
[[nodiscard]] Interval shadow_on_line(const Triangle& triangle, double px_m, double py_m, double dx,
                                      double dy) noexcept;

/// How often the triangle, seen from below, turns counter-clockwise around the upright ray that starts at the point:
/// 1, 0 or -1. Neighbours share no ray and leave none out, so that the sum over a closed surface is its winding number:
/// not 0 exactly inside.
[[nodiscard]] int winding_above(const Triangle& triangle, const Vector3& p_m) noexcept;

}  // namespace downwash
