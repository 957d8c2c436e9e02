#pragma once

// Private: not installed.

#include <array>
#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Triangles, counter-clockwise seen from outside.
struct Surface {
    std::vector<Vector3> vertices_m;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The surface of an obstacle in the world frame. Round shapes become polyhedra whose corners lie on them: cylinders of
/// 48 sides, spheres of 24 rings.
[[nodiscard]] DOWNWASH_EXPORT Surface surface_of(const Obstacle& obstacle);

/// Of an arm: a cylinder of 24 sides, from the origin along x.
[[nodiscard]] DOWNWASH_EXPORT Surface rod_surface(double length_m, double radius_m);

}  // namespace downwash
