#include "downwash/scene/mesh_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "downwash/scene/mesh_edges.hpp"

namespace downwash {

std::size_t shared_edges(const TriangleMesh& surface) {
    const auto edges = sorted_edges(surface, first_corners(surface.vertices_m));
    std::size_t count = 0;
    for_all_edges(edges, [&count](std::size_t first, std::size_t last) {
        count += last - first > 2 && (last - first) % 2 != 0 ? 1 : 0;
    });
    return count;
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
