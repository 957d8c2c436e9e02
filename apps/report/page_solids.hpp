#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// The solid of an obstacle in the coordinates of a plane: x, lateral, z; those of the world for a default plane. Null
/// for meshes and octrees of more than 20,000 triangles, so that a page stays small.
[[nodiscard]] nlohmann::ordered_json solid_json(const Obstacle& obstacle, const PlaneOfMotion& plane);

/// What a page calls a kind of shape: "octree".
[[nodiscard]] std::string_view kind_of(const Shape& shape) noexcept;

}  // namespace downwash
