#pragma once

// Private to scene/.

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/surface_facts.hpp"

namespace downwash {

/// What the triangles of a surface enclose. A piece of it is what edges connect.
enum class SurfaceKind {
    sheet,          ///< nothing: every piece has a rim, an edge at which an odd number of triangles meets, or is flat
    solid,          ///< space: along every edge the triangles go as often one way as the other, once turned
    mixed,          ///< some pieces are sheets and some are solid
    contradictory,  ///< some piece has no rim, but no turning of triangles tells inside from outside
};

/// The kind of a surface and what has to be done with its triangles.
struct MeshSides {
    SurfaceKind kind = SurfaceKind::sheet;
    std::vector<bool> is_turned;    ///< whether two corners of each triangle of a solid piece change places
    std::vector<bool> is_sheet;     ///< whether each triangle belongs to a piece with a rim, or a flat one
    std::vector<bool> is_repeated;  ///< whether each triangle is there already and is to be left out
    SurfaceFacts facts;             ///< without its boxes; the place is one of the surface
    double most_turned = 0;  ///< the largest share of turned triangles in what neighbours connect, at most a half
};

/// Corners of equal coordinates are one corner; triangles that come down to an edge do not count. Every piece is looked
/// at by itself:
/// - When a piece without a rim does not say one way around everywhere, its triangles are turned to agree across the
///   edges at which two meet, the fewest possible of each connected part, so that the walls of cavities stay what they
///   are.
/// - Triangles with the same three corners count once where that makes a piece a solid, and where all of them come in
///   pairs that go opposite ways: such faces have two sides, and enclose something only if their piece has no rim.
/// - A piece without a rim that encloses no volume is flat: a sheet that is there twice.
[[nodiscard]] DOWNWASH_EXPORT MeshSides sides_of(const TriangleMesh& surface);

}  // namespace downwash
