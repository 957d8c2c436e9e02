#include "downwash/scene/mesh_edges.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace downwash {

namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Equal for equal coordinates: zero has two signs.
std::uint64_t hash_of(const Vector3& place) {
    std::uint64_t mixed = 0;
    for (const double x : place) {
        mixed = (mixed ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15ULL;
        mixed ^= mixed >> 32U;
    }
    return mixed;
}

}  // namespace

std::vector<std::uint32_t> first_corners(const std::vector<Vector3>& vertices) {
    // Open addressing: the first vertex of every place stands at its hash, or behind others.
    const std::size_t mask = std::bit_ceil(2 * vertices.size() + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, no_vertex);
    std::vector<std::uint32_t> first(vertices.size());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        std::size_t at = hash_of(vertices[i]) & mask;
        while (table[at] != no_vertex && vertices[table[at]] != vertices[i]) {
            at = (at + 1) & mask;
        }
        table[at] = std::min(table[at], i);
        first[i] = table[at];
    }
    return first;
}

std::vector<Edge> sorted_edges(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner) {
    std::vector<Edge> edges;
    edges.reserve(3 * surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto& triangle = surface.triangles[t];
        const std::array<std::uint32_t, 3> at{corner[triangle[0]], corner[triangle[1]], corner[triangle[2]]};
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) {
            continue;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(at[i], at[(i + 1) % 3]);
            edges.push_back({low, high, static_cast<std::uint32_t>(3 * t + i), low == at[i]});
        }
    }
    const auto both = [](const Edge& edge) { return std::uint64_t{edge.low} << 32U | edge.high; };
    std::sort(edges.begin(), edges.end(), [&both](const Edge& a, const Edge& b) {
        return both(a) != both(b) ? both(a) < both(b) : a.side < b.side;
    });
    return edges;
}

}  // namespace downwash
