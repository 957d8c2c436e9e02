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
/// STL: every triangle has three vertices of its own; normals and attributes are not used. A file is binary when its
/// size is that of as many triangles as it says, whatever its first word. OBJ: vertices and faces are used; a face of
/// more than three corners becomes a fan around its first, as is right for convex ones. Statements about texture,
/// normals, groups, materials, lines and points are passed over, free-form curves and surfaces, calls of other files
/// and anything unknown are refused.
///
/// A file of more than 512 MiB, no or more than 2,000,000 triangles, more than 6,000,000 vertices, or coordinates that
/// are not finite or above 1e6 in size is refused, and so is whatever cannot be understood to its end.
/// @throws InputError "'file' line 7: what is wrong, what was expected", "byte 84" in binary files
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file);

/// The same for bytes that stand in memory; the end of their name says what they are. @throws InputError
[[nodiscard]] DOWNWASH_EXPORT TriangleMesh parse_mesh(std::string_view bytes, const std::string& name);

}  // namespace downwash
