#pragma once

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Joins corners of open edges that are meant to be one but differ by rounding, so that the pieces of a surface close.
///
/// Corners join within four steps of a float at the largest coordinate (at most 1e-3 of the extent), or within 1e-5 of
/// the extent, the longest side of the bounding box: the smaller distance of those that leave the fewest open edges,
/// and none if the surface has no open edge. Joined corners take the place of the first of them in the file. Triangles
/// without neighbours that would shrink to an edge stay as they are. Readers of meshes do this.
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh with_joined_corners(TriangleMesh surface);

}  // namespace downwash
