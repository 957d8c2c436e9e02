#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash::robot_import {

/// A solid around points.
struct EnclosingSolid {
    SpaceBodyShape body;
    /// How far it stands out from the convex hull of the points: the largest difference of both extents over some
    /// hundred directions, which is the Hausdorff distance of the two but for what lies between these directions [m].
    double excess_m = 0;
};

/// A solid that holds all points and has little volume, of those that robot files know: a box along the axes, a sphere,
/// or a cylinder or capsule along any direction. Of two solids, the simpler counts (in this
/// order: box, sphere, cylinder, capsule) unless the other is at least 1 % smaller. What is
/// thinner than a millimetre is taken as that thick.
/// @param axes directions along which the points may be long, beside the coordinate axes and their principal axes
/// @pre there are points, all finite
[[nodiscard]] DOWNWASH_EXPORT EnclosingSolid least_solid_around(const std::vector<Vector3>& points_m,
                                                                const std::vector<Vector3>& axes = {});

/// The box along the axes around points. @pre there are points
[[nodiscard]] DOWNWASH_EXPORT BoundingBox bounds_around(const std::vector<Vector3>& points_m);

/// The volume of a solid [m3].
[[nodiscard]] DOWNWASH_EXPORT double volume_m3(const SpaceShape& shape);

/// "box", "cylinder", "sphere" or "capsule".
[[nodiscard]] const char* name_of(const SpaceShape& shape) noexcept;

}  // namespace downwash::robot_import
