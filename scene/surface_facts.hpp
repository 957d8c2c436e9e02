#pragma once

#include <cstddef>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// What the scene made of a mesh or an octree. Edges and corners connect the triangles and boxes of a piece.
struct SurfaceFacts {
    std::size_t pieces = 0;
    std::size_t solid_pieces = 0;  ///< pieces that enclose space; all other pieces are sheets
    std::size_t open_edges = 0;    ///< edges of sheets with triangles on one side only
    Vector3 open_place{};          ///< middle of one open edge, in the unit and frame of the file; none: 0
};

/// How many pieces the solid boxes of an octree form; boxes that touch belong to the same one.
[[nodiscard]] DOWNWASH_EXPORT std::size_t piece_count(const Octomap& octomap);

}  // namespace downwash
