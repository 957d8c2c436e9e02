#pragma once

// Private: not installed.

#include <array>
#include <cstdint>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// The section of a surface with a plane.
struct MeshSection {
    std::vector<Ring> rings;  ///< closed
    std::vector<Ring> lines;  ///< open
};

/// The section of triangles with the plane lateral = 0; corners are (x, lateral, z). Vertices with equal coordinates
/// are one. Around solid parts of a closed surface whose corners run counter-clockwise seen from outside, rings run
/// counter-clockwise; around holes, clockwise.
[[nodiscard]] MeshSection mesh_section(const std::vector<Vector3>& vertices_m,
                                       const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace downwash
