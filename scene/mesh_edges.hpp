#pragma once

// Private to scene/.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "downwash/scene/shapes.hpp"

namespace downwash {

/// One side of a triangle.
struct Edge {
    std::uint32_t low, high;  ///< its corners, as first_corners() numbers them
    std::uint32_t side;       ///< 3 times the triangle plus which side of it
    bool is_upward;           ///< goes from the low corner to the high one

    [[nodiscard]] std::uint32_t triangle() const noexcept { return side / 3; }
};

/// For every vertex the first one with the same coordinates.
[[nodiscard]] std::vector<std::uint32_t> first_corners(const std::vector<Vector3>& vertices);

/// The sides of all triangles, those along the same edge in a row. Triangles that come down to an edge have none.
/// @param corner first_corners() of the surface, or a coarser numbering of its vertices
[[nodiscard]] std::vector<Edge> sorted_edges(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner);

/// Calls `visit(first, last)` with the sides along each edge, until it returns false; whether it never did.
template <class Visit>
bool all_edges(const std::vector<Edge>& edges, const Visit& visit) {
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t last = first + 1;
        while (last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high) {
            ++last;
        }
        if (!visit(first, last)) {
            return false;
        }
        first = last;
    }
    return true;
}

/// Calls `visit(first, last)` with the sides along each edge.
template <class Visit>
void for_all_edges(const std::vector<Edge>& edges, const Visit& visit) {
    all_edges(edges, [&visit](std::size_t first, std::size_t last) {
        visit(first, last);
        return true;
    });
}

}  // namespace downwash
