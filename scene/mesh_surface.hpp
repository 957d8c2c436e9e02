#pragma once

// Private to scene/.

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/triangle.hpp"

namespace downwash {

/// Adds what is wrong with a mesh, under keys such as `key`.mesh.file.
void inspect(const Mesh& mesh, const std::string& key, std::vector<KeyError>& errors);

/// The triangles that have an area, corners scaled, in the local frame.
/// @param is_turned for each triangle whether two of its corners change places; empty for none
[[nodiscard]] std::vector<Triangle> scaled_triangles(const Mesh& mesh, const std::vector<bool>& is_turned);

}  // namespace downwash
