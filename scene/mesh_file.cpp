#include "downwash/scene/mesh_file.hpp"

#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/scene/foreign_file.hpp"
#include "downwash/scene/mesh_welding.hpp"

namespace downwash {

std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file) {
    return std::make_shared<const TriangleMesh>(parse_mesh(foreign::read(file), file.string()));
}

TriangleMesh parse_mesh(std::string_view bytes, const std::string& name) {
    const std::string ending = std::filesystem::path(name).extension().string();
    const bool is_stl = is_same_word(ending, ".stl");
    if (!is_stl && !is_same_word(ending, ".obj")) {
        foreign::fail(name, "is of an unknown kind: expected a name that ends in .stl or .obj");
    }
    TriangleMesh mesh = is_stl ? foreign::parse_stl(bytes, name) : foreign::parse_obj(bytes, name);
    if (mesh.triangles.empty()) {
        foreign::fail(name, "has no triangles: expected at least one");
    }
    return with_joined_corners(std::move(mesh));
}

}  // namespace downwash
