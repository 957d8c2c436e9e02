#pragma once

// Private to scene/.

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// What the triangles of a surface enclose.
enum class SurfaceKind {
    sheet,          ///< nothing: some edge is the rim, an odd number of triangles meets there
    solid,          ///< space: along every edge the triangles go as often one way as the other, once turned
    contradictory,  ///< there is no rim, but no turning of triangles tells inside from outside
};

/// The kind of a surface and how its triangles have to be turned for it.
struct MeshSides {
    SurfaceKind kind = SurfaceKind::sheet;
    std::vector<bool> is_turned;  ///< whether two corners of each triangle of a solid change places
};

/// Corners of equal coordinates are one corner; triangles that come down to an edge do not count. When a surface
/// without a rim does not say one way around everywhere, its triangles are turned to agree across the edges at which
/// two meet, the fewest possible of each connected piece, so that the walls of cavities stay what they are.
[[nodiscard]] DOWNWASH_EXPORT MeshSides sides_of(const TriangleMesh& surface);

}  // namespace downwash
