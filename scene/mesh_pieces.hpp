#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// The vertices of each piece of a surface whose triangles share corners, in the order of the pieces' first triangles.
/// Corners of equal coordinates are one corner; a piece has it as often as triangles use different vertices there.
/// Vertices without a triangle are in none.
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<Vector3>> connected_pieces(const TriangleMesh& surface);

}  // namespace downwash
