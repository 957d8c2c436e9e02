#pragma once

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash {

/// The surface of an obstacle in the world frame. Round shapes become polyhedra whose corners lie on them: cylinders of
/// 48 sides, spheres of 24 rings.
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh surface_of(const Obstacle& obstacle);

/// The surface of a solid of a robot in space, in the frame of its body. The ends of a capsule are halves of such
/// spheres.
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh surface_of(const SpaceBodyShape& body);

/// The surface of an arm: a cylinder of 24 sides, from the origin along x.
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh rod_surface(double length_m, double radius_m);

}  // namespace downwash
