#include "downwash/scene/shape_digest.hpp"

#include <span>

#include "downwash/base/sha256.hpp"

namespace downwash {
namespace {

static_assert(sizeof(OccupiedCube) == 4 * sizeof(double), "no bytes between the numbers");
static_assert(sizeof(LocalBox) == 6 * sizeof(double), "no bytes between the numbers");

}  // namespace

std::string digest_of(const TriangleMesh& mesh) {
    return sha256_hex(sha256_hex_of(std::span(mesh.vertices_m)) + sha256_hex_of(std::span(mesh.triangles)));
}

std::string digest_of(const Octomap& octomap) {
    const OccupancyTree& tree = *octomap.tree;
    const bool is_filled = octomap.unknown == UnknownSpace::occupied;
    return sha256_hex(sha256_hex_of(std::span(&tree.resolution_m, 1)) + sha256_hex_of(std::span(tree.cubes)) +
                      (is_filled ? sha256_hex_of(std::span(tree.unseen)) : ""));
}

}  // namespace downwash
