#pragma once

// Private to scene/.

#include "downwash/scene/convex.hpp"

namespace downwash {

/// Whether FCL finds two solids in contact: boxes, cylinders, capsules, spheres, and triangles as meshes of one. Hands
/// FCL one pair at a time, for our own tree has found it already: FCL's trees over a whole mesh or octree would hold
/// everything once more, at 300 bytes a triangle. Allocates.
[[nodiscard]] bool fcl_says_contact(const Convex& a, const Convex& b);

}  // namespace downwash
