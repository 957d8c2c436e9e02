#include "downwash/scene/mesh_pieces.hpp"

#include <cstdint>
#include <limits>
#include <numeric>

#include "downwash/scene/mesh_edges.hpp"

namespace downwash {

std::vector<std::vector<Vector3>> connected_pieces(const TriangleMesh& surface) {
    const std::vector<std::uint32_t> corner = first_corners(surface.vertices_m);
    std::vector<std::uint32_t> parent(surface.vertices_m.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root_of = [&parent](std::uint32_t at) {
        while (parent[at] != at) {
            at = parent[at] = parent[parent[at]];
        }
        return at;
    };
    for (const auto& triangle : surface.triangles) {
        for (const std::size_t other : {1U, 2U}) {
            parent[root_of(corner[triangle[other]])] = root_of(corner[triangle[0]]);
        }
    }
    constexpr std::uint32_t no_piece = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> piece_of(parent.size(), no_piece);
    std::vector<bool> is_taken(parent.size());
    std::vector<std::vector<Vector3>> pieces;
    for (const auto& triangle : surface.triangles) {
        for (const std::uint32_t vertex : triangle) {
            std::uint32_t& piece = piece_of[root_of(corner[vertex])];
            if (piece == no_piece) {
                piece = static_cast<std::uint32_t>(pieces.size());
                pieces.emplace_back();
            }
            if (!is_taken[vertex]) {
                is_taken[vertex] = true;
                pieces[piece].push_back(surface.vertices_m[vertex]);
            }
        }
    }
    return pieces;
}

}  // namespace downwash
