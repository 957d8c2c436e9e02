#include "downwash/scene/mesh_welding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/mesh_edges.hpp"
#include "downwash/scene/mesh_sides.hpp"

namespace downwash {
namespace {

/// Shares of the extent.
constexpr double joining_share = 1e-5;
constexpr double max_joining_share = 1e-3;
/// What a few operations in single precision leave, of the largest coordinate.
constexpr double float_share = 4 * 0x1p-23;

/// Within which distances corners may join, and where they begin.
struct Extent {
    Vector3 low;
    std::array<double, 2> distances;  ///< in rising order
};

Extent extent_of(const TriangleMesh& surface) {
    const Vector3& start = surface.vertices_m[surface.triangles[0][0]];
    BoundingBox bounds{start, start};
    double largest = 0;
    for (const auto& triangle : surface.triangles) {
        for (const std::uint32_t corner : triangle) {
            const Vector3& vertex = surface.vertices_m[corner];
            bounds.include({vertex, vertex});
            largest = std::max({largest, std::abs(vertex[0]), std::abs(vertex[1]), std::abs(vertex[2])});
        }
    }
    const Vector3 size = bounds.high_m - bounds.low_m;
    const double extent = std::max({size[0], size[1], size[2]});
    const auto [low, high] =
        std::minmax({joining_share * extent, std::min(float_share * largest, max_joining_share * extent)});
    return {bounds.low_m, {low, high}};
}

/// Places in a grid of cubes, to find those near to another.
class NearPlaces {
 public:
    /// @param low no place is lower
    NearPlaces(const Vector3& low, double distance) : low_(low), distance_(distance) {}

    /// The first place within the distance that was added; nothing: -1
    [[nodiscard]] std::int64_t find(const std::vector<Vector3>& vertices, const Vector3& place) const {
        const Vector3 around{distance_, distance_, distance_};
        const Cell low = cell_of(place - around);
        const Cell high = cell_of(place + around);
        std::int64_t found = -1;
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    const auto last = last_in_.find(hash({x, y, z}));
                    for (std::int64_t at = last == last_in_.end() ? -1 : last->second; at >= 0;
                         at = chain_[static_cast<std::size_t>(at)].second) {
                        const std::uint32_t vertex = chain_[static_cast<std::size_t>(at)].first;
                        const Vector3 way = vertices[vertex] - place;
                        if (dot(way, way) <= distance_ * distance_ && (found < 0 || vertex < found)) {
                            found = vertex;
                        }
                    }
                }
            }
        }
        return found;
    }
    void add(std::uint32_t vertex, const Vector3& place) {
        const auto [last, is_new] = last_in_.try_emplace(hash(cell_of(place)), -1);
        chain_.emplace_back(vertex, last->second);
        last->second = static_cast<std::int64_t>(chain_.size()) - 1;
    }

 private:
    using Cell = std::array<std::int64_t, 3>;

    /// Places in a cell are farther apart than the distance, so that it holds a hundred or so however dense they lie;
    /// and cells are so large that a place has to look into few.
    [[nodiscard]] Cell cell_of(const Vector3& place) const {
        const auto cell = [&](std::size_t k) {
            return static_cast<std::int64_t>(std::floor((place[k] - low_[k]) / (4 * distance_)));
        };
        return {cell(0), cell(1), cell(2)};
    }
    /// Cells may share one: distances decide.
    static std::uint64_t hash(const Cell& cell) {
        std::uint64_t mixed = 0;
        for (const std::int64_t k : cell) {
            mixed = (mixed ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15ULL;
            mixed ^= mixed >> 29U;
        }
        return mixed;
    }

    Vector3 low_;
    double distance_;
    std::unordered_map<std::uint64_t, std::int64_t> last_in_;    ///< the last one of chain_ in each cell
    std::vector<std::pair<std::uint32_t, std::int64_t>> chain_;  ///< a place, and the one before it in its cell
};

/// Which corners lie at open edges.
std::vector<bool> corners_of_rim(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner) {
    std::vector<bool> is_at_rim(surface.vertices_m.size());
    const std::vector<Edge> edges = sorted_edges(surface, corner);
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        if ((last - first) % 2 != 0) {
            is_at_rim[edges[first].low] = is_at_rim[edges[first].high] = true;
        }
    });
    return is_at_rim;
}

/// For every corner the one that it joins.
std::vector<std::uint32_t> joined(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner,
                                  const std::vector<bool>& may_move, const Vector3& low, double distance) {
    std::vector<std::uint32_t> target = corner;
    NearPlaces places(low, distance);
    for (std::uint32_t i = 0; i < corner.size(); ++i) {
        if (corner[i] == i && may_move[i]) {
            const std::int64_t near = places.find(surface.vertices_m, surface.vertices_m[i]);
            if (near >= 0) {
                target[i] = static_cast<std::uint32_t>(near);
            } else {
                places.add(i, surface.vertices_m[i]);
            }
        }
    }
    for (std::uint32_t i = 0; i < corner.size(); ++i) {
        target[i] = target[corner[i]];
    }
    return target;
}

/// Keeps the corners of triangles in place that would shrink to an edge or corner where no other triangle is: they
/// would be gone.
/// @return whether there are some
bool keep_strips(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner,
                 const std::vector<std::uint32_t>& target, std::vector<bool>& may_move) {
    const std::vector<Edge> edges = sorted_edges(surface, target);
    const auto is_edge = [&edges](std::uint32_t a, std::uint32_t b) {
        const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(a, b);
        const auto at = std::lower_bound(edges.begin(), edges.end(), key, [](const Edge& edge, const auto& wanted) {
            return std::pair(edge.low, edge.high) < wanted;
        });
        return at != edges.end() && at->low == key.first && at->high == key.second;
    };
    std::vector<bool> is_used(corner.size());
    for (const Edge& edge : edges) {
        is_used[edge.low] = is_used[edge.high] = true;
    }
    bool has_kept = false;
    for (const auto& [i, j, k] : surface.triangles) {
        const std::array<std::uint32_t, 3> before{corner[i], corner[j], corner[k]};
        const std::array<std::uint32_t, 3> after{target[i], target[j], target[k]};
        const bool was_edge = before[0] == before[1] || before[1] == before[2] || before[2] == before[0];
        const auto [low, high] = std::minmax_element(after.begin(), after.end());
        const bool is_edge_now = after[0] == after[1] || after[1] == after[2] || after[2] == after[0];
        const bool is_left = *low == *high ? is_used[*low] : is_edge(*low, *high);
        if (!was_edge && is_edge_now && !is_left) {
            for (const std::uint32_t own : before) {
                has_kept = has_kept || may_move[own];
                may_move[own] = false;
            }
        }
    }
    return has_kept;
}

TriangleMesh joined_within(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner,
                           std::vector<bool> may_move, const Vector3& low, double distance) {
    constexpr int max_rounds = 8;
    std::vector<std::uint32_t> target = joined(surface, corner, may_move, low, distance);
    for (int round = 0; keep_strips(surface, corner, target, may_move); ++round) {
        if (round == max_rounds) {
            return surface;
        }
        target = joined(surface, corner, may_move, low, distance);
    }
    TriangleMesh moved = surface;
    for (std::size_t i = 0; i < target.size(); ++i) {
        moved.vertices_m[i] = surface.vertices_m[target[i]];
    }
    return moved;
}

}  // namespace

TriangleMesh with_joined_corners(TriangleMesh surface) {
    if (surface.triangles.empty()) {
        return surface;
    }
    std::size_t open_edges = sides_of(surface).facts.open_edges;
    if (open_edges == 0) {
        return surface;
    }
    const std::vector<std::uint32_t> corner = first_corners(surface.vertices_m);
    const std::vector<bool> is_at_rim = corners_of_rim(surface, corner);
    std::optional<TriangleMesh> best;
    const Extent extent = extent_of(surface);
    for (const double distance : extent.distances) {
        if (!(distance > 0) || open_edges == 0) {
            continue;
        }
        TriangleMesh moved = joined_within(surface, corner, is_at_rim, extent.low, distance);
        const MeshSides sides = sides_of(moved);
        if (sides.kind != SurfaceKind::contradictory && sides.facts.open_edges < open_edges) {
            open_edges = sides.facts.open_edges;
            best = std::move(moved);
        }
    }
    return best ? *std::move(best) : std::move(surface);
}

}  // namespace downwash
