#pragma once

// Private to scene/: the formats behind read_mesh.

#include <string>
#include <string_view>

#include "downwash/scene/shapes.hpp"

namespace downwash::foreign {

/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes, const std::string& name);
/// @throws InputError; the caller rejects an empty mesh
[[nodiscard]] TriangleMesh parse_obj(std::string_view text, const std::string& name);

}  // namespace downwash::foreign
