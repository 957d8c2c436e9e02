#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// SHA-256 of a surface's vertices and triangles, down to the last bit and in their order, as 64 hexadecimal digits.
[[nodiscard]] DOWNWASH_EXPORT std::string digest_of(const TriangleMesh& mesh);

/// SHA-256 of an octree's resolution and cubes, in hexadecimal digits.
[[nodiscard]] DOWNWASH_EXPORT std::string digest_of(const OccupancyTree& tree);

}  // namespace downwash
