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
/// fits the number of triangles that it states, whatever its first word; else it is text if it begins with "solid".
/// OBJ: vertices and faces are read. Faces of more than three corners are cut into triangles (polygon_triangles.hpp).
/// Statements about texture, normals, groups, materials, lines and points are ignored. Free-form curves and surfaces,
/// calls of other files and anything unknown are errors. What is passed over although it may matter is a remark.
///
/// Corners at open edges that differ by rounding are joined (with_joined_corners()).
///
/// A file is rejected if it has more than 512 MiB, no or more than 2,000,000 triangles, more than 6,000,000 vertices,
/// coordinates that are not finite or above 1e10 in size, or faces that cannot be cut, if it is UTF-16, or if it cannot
/// be parsed to its end.
/// @throws InputError "'file' line 7: what is wrong, what was expected", "byte 84" in binary files
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file);

/// Reads a mesh from bytes in memory; the ending of the name gives the format. @throws InputError
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh parse_mesh(std::string_view bytes, const std::string& name);

}  // namespace downwash
