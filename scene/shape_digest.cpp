#include "downwash/scene/shape_digest.hpp"

#include <string_view>
#include <type_traits>

#include "downwash/base/sha256.hpp"

namespace downwash {
namespace {

/// The digest of numbers as they lie in memory; all our machines are little-endian.
template <class Element>
std::string digest_of_bytes(const Element* elements, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Element>);
    return sha256_hex({reinterpret_cast<const char*>(elements), count * sizeof(Element)});
}

static_assert(sizeof(OccupiedCube) == 4 * sizeof(double), "no bytes between the numbers");

}  // namespace

std::string digest_of(const TriangleMesh& mesh) {
    return sha256_hex(digest_of_bytes(mesh.vertices_m.data(), mesh.vertices_m.size()) +
                      digest_of_bytes(mesh.triangles.data(), mesh.triangles.size()));
}

std::string digest_of(const OccupancyTree& tree) {
    return sha256_hex(digest_of_bytes(&tree.resolution_m, 1) + digest_of_bytes(tree.cubes.data(), tree.cubes.size()));
}

}  // namespace downwash
