#include "downwash/report/mesh_section.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "downwash/report/chains.hpp"

namespace downwash {
namespace {

/// An edge by the smaller and the larger index of its ends.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The pieces of single triangles, each from the edge where it begins to the one where it ends.
using Pieces = std::multimap<Edge, Edge>;

Pieces pieces_of(const std::vector<Vector3>& vertices_m, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::map<Vector3, std::uint32_t> first;  // vertices with equal coordinates share an index
    const auto welded = [&](std::uint32_t vertex) { return first.emplace(vertices_m[vertex], vertex).first->second; };
    Pieces pieces;
    for (const auto& triangle : triangles) {
        std::array<Edge, 2> ends{};  // where the boundary crosses to the left of the plane, and back
        bool is_cut = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle[i];
            const std::uint32_t to = triangle[(i + 1) % 3];
            const bool is_from_left = vertices_m[from][1] >= 0;
            if (is_from_left != (vertices_m[to][1] >= 0)) {
                ends[is_from_left ? 1 : 0] = std::minmax(welded(from), welded(to));
                is_cut = true;
            }
        }
        if (is_cut) {
            pieces.emplace(ends[0], ends[1]);
        }
    }
    return pieces;
}

PlanePoint point_on(const Edge& edge, const std::vector<Vector3>& vertices_m) {
    const Vector3& a = vertices_m[edge.first];
    const Vector3& b = vertices_m[edge.second];
    const double part = a[1] / (a[1] - b[1]);
    return {a[0] + part * (b[0] - a[0]), a[2] + part * (b[2] - a[2])};
}

}  // namespace

MeshSection mesh_section(const std::vector<Vector3>& vertices_m,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    Pieces pieces = pieces_of(vertices_m, triangles);
    MeshSection section;
    for (auto& edges : take_chains(pieces)) {
        const bool is_ring = edges.size() > 1 && edges.front() == edges.back();
        if (is_ring) {
            edges.pop_back();
        }
        auto& points = (is_ring ? section.rings : section.lines).emplace_back();
        for (const Edge& edge : edges) {
            points.push_back(point_on(edge, vertices_m));
        }
    }
    return section;
}

}  // namespace downwash
