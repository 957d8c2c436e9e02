#pragma once

#include <cstddef>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Edges at which three or more triangles meet, an odd number of them: where the rooms of a building share a wall.
[[nodiscard]] DOWNWASH_EXPORT std::size_t shared_edges(const TriangleMesh& surface);

/// A corner of an open edge that lies within another open edge: there triangles meet that share no corner. None either
/// where there are more open edges than can be compared in a moment.
[[nodiscard]] DOWNWASH_EXPORT std::optional<Vector3> t_junction(const TriangleMesh& surface);

/// Of the connected triangles of closed shells, the largest share that faces the other way than the rest, at most a
/// half. The scene turns them; whether such a shell is solid or the wall of a cavity is then what most of them say.
[[nodiscard]] DOWNWASH_EXPORT double most_turned(const TriangleMesh& surface);

/// Distance of numbers of single precision where a surface has its largest coordinate, in the unit of its file; 0 if
/// some coordinate is not such a number.
[[nodiscard]] DOWNWASH_EXPORT double single_precision_step(const TriangleMesh& surface);

}  // namespace downwash
