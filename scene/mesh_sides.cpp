#include "downwash/scene/mesh_sides.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace downwash {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// One side of a triangle.
struct Edge {
    std::uint32_t low, high;  ///< its corners
    std::uint32_t side;       ///< 3 times the triangle plus which side of it
    bool is_upward;           ///< goes from the low corner to the high one
};

/// The triangle across a side, when it is the only one there.
struct Neighbour {
    std::uint32_t triangle = nobody;
    bool disagrees = false;  ///< goes along the common edge the same way
};

/// For every vertex the first one with the same coordinates.
std::vector<std::uint32_t> welded(const std::vector<Vector3>& vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return vertices[a] < vertices[b] || (vertices[a] == vertices[b] && a < b);
    });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_known = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
        first[order[i]] = is_known ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// The sides of all triangles, those along the same edge in a row.
std::vector<Edge> sorted_edges(const TriangleMesh& surface) {
    const std::vector<std::uint32_t> corner = welded(surface.vertices_m);
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
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side);
    });
    return edges;
}

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

bool has_rim(const std::vector<Edge>& edges) {
    return !all_edges(edges, [](std::size_t first, std::size_t last) { return (last - first) % 2 == 0; });
}

/// Whether along every edge the triangles go as often one way as the other.
bool is_balanced(const std::vector<Edge>& edges, const std::vector<bool>& is_turned) {
    return all_edges(edges, [&](std::size_t first, std::size_t last) {
        int balance = 0;
        for (std::size_t i = first; i < last; ++i) {
            balance += edges[i].is_upward != is_turned[edges[i].side / 3] ? 1 : -1;
        }
        return balance == 0;
    });
}

/// By side of triangle.
std::vector<Neighbour> neighbours_of(const std::vector<Edge>& edges, std::size_t triangle_count) {
    std::vector<Neighbour> neighbours(3 * triangle_count);
    all_edges(edges, [&](std::size_t first, std::size_t last) {
        if (last - first == 2) {
            const Edge& a = edges[first];
            const Edge& b = edges[first + 1];
            const bool disagrees = a.is_upward == b.is_upward;
            neighbours[a.side] = {b.side / 3, disagrees};
            neighbours[b.side] = {a.side / 3, disagrees};
        }
        return true;
    });
    return neighbours;
}

/// Turns triangles until neighbours agree. Where they cannot, some edge stays out of balance.
std::vector<bool> turned_to_agree(const std::vector<Neighbour>& neighbours) {
    const std::size_t count = neighbours.size() / 3;
    std::vector<bool> is_turned(count);
    std::vector<bool> is_reached(count);
    std::vector<std::uint32_t> piece;  // the connected triangles around one, in the order in which they are reached
    for (std::uint32_t start = 0; start < count; ++start) {
        if (is_reached[start]) {
            continue;
        }
        is_reached[start] = true;
        piece.assign(1, start);
        std::size_t turned_count = 0;
        for (std::size_t next = 0; next < piece.size(); ++next) {
            const std::uint32_t triangle = piece[next];
            turned_count += is_turned[triangle] ? 1 : 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const Neighbour& other = neighbours[3 * triangle + i];
                if (other.triangle != nobody && !is_reached[other.triangle]) {
                    is_reached[other.triangle] = true;
                    is_turned[other.triangle] = is_turned[triangle] != other.disagrees;
                    piece.push_back(other.triangle);
                }
            }
        }
        if (2 * turned_count > piece.size()) {
            for (const std::uint32_t triangle : piece) {
                is_turned[triangle] = !is_turned[triangle];
            }
        }
    }
    return is_turned;
}

}  // namespace

MeshSides sides_of(const TriangleMesh& surface) {
    const std::vector<Edge> edges = sorted_edges(surface);
    if (has_rim(edges)) {
        return {SurfaceKind::sheet, {}};
    }
    std::vector<bool> is_turned(surface.triangles.size());
    if (!is_balanced(edges, is_turned)) {
        is_turned = turned_to_agree(neighbours_of(edges, surface.triangles.size()));
        if (!is_balanced(edges, is_turned)) {
            return {SurfaceKind::contradictory, {}};
        }
    }
    return {SurfaceKind::solid, std::move(is_turned)};
}

}  // namespace downwash
