#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// What the file of a mesh or an octree became in the world.
struct GeometryFacts {
    std::size_t obstacle = 0;       ///< its number in Scene::obstacles()
    std::size_t element_count = 0;  ///< triangles of the file, or occupied cubes
    BoundingBox extent_world_m;
    SurfaceFacts surface;  ///< an octree is solid in all of its pieces
};

/// Every mesh and octree of a scene, in the order of its obstacles.
[[nodiscard]] DOWNWASH_EXPORT std::vector<GeometryFacts> geometry_facts(const Scene& scene);

}  // namespace downwash
