#pragma once

// Private to scene/.

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/fault.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Adds what is wrong with a mesh, under keys such as `key`.mesh.file.
void inspect(const Mesh& mesh, const std::string& key, std::vector<Fault>& faults);

/// Whether a surface has no rim, so that it separates an inside from an outside: along every edge it is gone through
/// as often one way as the other. Corners of equal coordinates are one corner.
[[nodiscard]] DOWNWASH_EXPORT bool is_closed(const TriangleMesh& surface);

/// The triangles that have an area, corners scaled, in the local frame.
[[nodiscard]] std::vector<std::array<Vector3, 3>> scaled_triangles(const Mesh& mesh);

}  // namespace downwash
