#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// SHA-256 of a surface's vertices and triangles, down to the last bit and in their order, as 64 hexadecimal digits.
[[nodiscard]] DOWNWASH_EXPORT std::string digest_of(const TriangleMesh& mesh);

/// SHA-256 of what is solid in an octree: its resolution and cubes and, where it counts as occupied, its unseen space;
/// in hexadecimal digits. @pre the octree was read
[[nodiscard]] DOWNWASH_EXPORT std::string digest_of(const Octomap& octomap);

}  // namespace downwash
