#pragma once

#include <cstddef>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Edges at which three or more triangles meet, an odd number of them: where the rooms of a building share a wall.
[[nodiscard]] DOWNWASH_EXPORT std::size_t shared_edges(const TriangleMesh& surface);

/// Distance of numbers of single precision where a surface has its largest coordinate, in the unit of its file; 0 if
/// some coordinate is not such a number.
[[nodiscard]] DOWNWASH_EXPORT double single_precision_step(const TriangleMesh& surface);

}  // namespace downwash
