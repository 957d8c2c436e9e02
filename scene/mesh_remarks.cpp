#include "downwash/scene/mesh_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "downwash/scene/mesh_edges.hpp"
#include "downwash/scene/mesh_sides.hpp"

namespace downwash {

std::size_t shared_edges(const TriangleMesh& surface) {
    const auto edges = sorted_edges(surface, first_corners(surface.vertices_m));
    std::size_t count = 0;
    for_all_edges(edges, [&count](std::size_t first, std::size_t last) {
        count += last - first > 2 && (last - first) % 2 != 0 ? 1 : 0;
    });
    return count;
}

std::optional<Vector3> t_junction(const TriangleMesh& surface) {
    constexpr std::size_t most_edges = 2000;
    constexpr double rounding = 1e-5;  // of the length of the edge
    const auto edges = sorted_edges(surface, first_corners(surface.vertices_m));
    std::vector<Edge> open;
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        if ((last - first) % 2 != 0) {
            open.push_back(edges[first]);
        }
    });
    if (open.size() > most_edges) {
        return std::nullopt;
    }
    for (const Edge& edge : open) {
        const Vector3& from = surface.vertices_m[edge.low];
        const Vector3 along = surface.vertices_m[edge.high] - from;
        const double squared = dot(along, along);
        for (const Edge& other : open) {
            for (const std::uint32_t corner : {other.low, other.high}) {
                const Vector3 to = surface.vertices_m[corner] - from;
                const double share = dot(to, along) / squared;
                const Vector3 off = to - share * along;
                if (share > rounding && share < 1 - rounding && dot(off, off) <= rounding * rounding * squared) {
                    return surface.vertices_m[corner];
                }
            }
        }
    }
    return std::nullopt;
}

double most_turned(const TriangleMesh& surface) {
    return sides_of(surface).most_turned;
}

double single_precision_step(const TriangleMesh& surface) {
    double largest = 0;
    for (const auto& triangle : surface.triangles) {
        for (const std::uint32_t corner : triangle) {
            for (const double x : surface.vertices_m[corner]) {
                if (static_cast<double>(static_cast<float>(x)) != x) {
                    return 0;
                }
                largest = std::max(largest, std::abs(x));
            }
        }
    }
    const auto last = static_cast<float>(largest);
    return static_cast<double>(std::nextafter(last, std::numeric_limits<float>::infinity())) - largest;
}

}  // namespace downwash
