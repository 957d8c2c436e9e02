#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Reads the triangles of a file whose name ends in .stl (binary or ASCII) or .obj (Wavefront).
///
/// STL: every triangle has three vertices of its own. Normals and attributes are ignored. A file is binary if its size
/// fits the number of triangles that it states, whatever its first word. OBJ: vertices and faces are read. A face of
/// more than three corners becomes a fan around its first, which is right for convex faces. Statements about texture,
/// normals, groups, materials, lines and points are ignored. Free-form curves and surfaces, calls of other files and
/// anything unknown are errors.
///
/// A file is rejected if it has more than 512 MiB, no or more than 2,000,000 triangles, more than 6,000,000 vertices,
/// or coordinates that are not finite or above 1e6 in size, or if it cannot be parsed to its end.
/// @throws InputError "'file' line 7: what is wrong, what was expected", "byte 84" in binary files
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file);

/// Reads a mesh from bytes in memory; the ending of the name gives the format. @throws InputError
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh parse_mesh(std::string_view bytes, const std::string& name);

}  // namespace downwash
