#include "downwash/report/planar_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace downwash {
namespace {

/// The position of a corner, in steps above the rounding error.
using Corner = std::pair<long long, long long>;

constexpr double step_m = 1e-7;

Corner corner_at(const PlanePoint& p) {
    return {std::llround(p.x_m / step_m), std::llround(p.z_m / step_m)};
}

/// The ring without corners on straight lines.
Ring straightened(const Ring& ring) {
    Ring kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PlanePoint& before = ring[(i + ring.size() - 1) % ring.size()];
        const PlanePoint& after = ring[(i + 1) % ring.size()];
        const double length_m = std::hypot(after.x_m - before.x_m, after.z_m - before.z_m);
        // Twice the area over the base is the height of the corner.
        if (std::abs(turn(before, ring[i], after)) > 2 * step_m * length_m) {
            kept.push_back(ring[i]);
        }
    }
    return kept;
}

/// Removes all steps from a map or multimap of places to their successors and joins them to chains: first open ones,
/// then closed ones, whose last place is their first.
template <class Steps>
std::vector<std::vector<typename Steps::key_type>> take_chains(Steps& steps) {
    using Place = typename Steps::key_type;
    std::set<Place> arrivals;
    for (const auto& [from, to] : steps) {
        arrivals.insert(to);
    }
    std::vector<Place> beginnings;
    for (const auto& [from, to] : steps) {
        if (arrivals.count(from) == 0) {
            beginnings.push_back(from);
        }
    }
    std::vector<std::vector<Place>> chains;
    const auto follow = [&](Place first) {
        std::vector<Place> chain{first};
        for (auto step = steps.find(first); step != steps.end(); step = steps.find(chain.back())) {
            chain.push_back(step->second);
            steps.erase(step);
            if (chain.back() == first) {
                break;
            }
        }
        chains.push_back(std::move(chain));
    };
    for (const Place& beginning : beginnings) {
        follow(beginning);
    }
    while (!steps.empty()) {
        follow(steps.begin()->first);
    }
    return chains;
}

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

PlanePoint point_between(const PlanePoint& a, const PlanePoint& b, double part) {
    return {a.x_m + part * (b.x_m - a.x_m), a.z_m + part * (b.z_m - a.z_m)};
}

/// How far a point is on the inner side of each of the four edges of an extent.
std::array<double, 4> depths(const PlanePoint& p, const Bounds& extent) {
    return {p.x_m - extent.x_low_m, extent.x_high_m - p.x_m, p.z_m - extent.z_low_m, extent.z_high_m - p.z_m};
}

/// The part of a piece of line within an extent, from and to as parts of its length (Liang and Barsky 1984).
std::optional<std::pair<double, double>> part_within(const PlanePoint& a, const PlanePoint& b, const Bounds& extent) {
    const std::array<double, 4> at_a = depths(a, extent), at_b = depths(b, extent);
    double from = 0, to = 1;
    for (std::size_t edge = 0; edge < at_a.size(); ++edge) {
        if (at_a[edge] < 0 && at_b[edge] < 0) {
            return std::nullopt;
        }
        if (at_a[edge] < 0) {
            from = std::max(from, at_a[edge] / (at_a[edge] - at_b[edge]));
        } else if (at_b[edge] < 0) {
            to = std::min(to, at_a[edge] / (at_a[edge] - at_b[edge]));
        }
    }
    if (!(from < to)) {
        return std::nullopt;
    }
    return std::pair(from, to);
}

}  // namespace

// Sutherland and Hodgman 1974: one edge of the extent after the other.
Ring clipped_ring(const Ring& ring, const Bounds& extent) {
    Ring part = ring;
    for (std::size_t edge = 0; edge < 4; ++edge) {
        Ring kept;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const PlanePoint &a = part[i], &b = part[(i + 1) % part.size()];
            const double at_a = depths(a, extent)[edge], at_b = depths(b, extent)[edge];
            if (at_a >= 0) {
                kept.push_back(a);
            }
            if ((at_a >= 0) != (at_b >= 0)) {
                kept.push_back(point_between(a, b, at_a / (at_a - at_b)));
            }
        }
        part = std::move(kept);
    }
    return part;
}

std::vector<Ring> clipped_line(const Ring& line, bool is_closed, const Bounds& extent) {
    std::vector<Ring> pieces;
    bool is_open = false;  // whether the last piece reaches the point that comes next
    for (std::size_t i = 0; i + (is_closed ? 0 : 1) < line.size(); ++i) {
        const PlanePoint &a = line[i], &b = line[(i + 1) % line.size()];
        const auto within = part_within(a, b, extent);
        if (!within) {
            is_open = false;
            continue;
        }
        if (!is_open || within->first > 0) {
            pieces.push_back({point_between(a, b, within->first)});
        }
        pieces.back().push_back(within->second < 1 ? point_between(a, b, within->second) : b);
        is_open = within->second >= 1;
    }
    return pieces;
}

// Andrew's monotone chain.
Bounds box_of(const std::vector<Ring>& lines) {
    Bounds box{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (const Ring& line : lines) {
        for (const PlanePoint& p : line) {
            box = {std::min(box.x_low_m, p.x_m), std::max(box.x_high_m, p.x_m), std::min(box.z_low_m, p.z_m),
                   std::max(box.z_high_m, p.z_m)};
        }
    }
    return box;
}

Ring convex_hull(std::vector<PlanePoint> points) {
    const auto is_before = [](const PlanePoint& a, const PlanePoint& b) {
        return a.x_m < b.x_m || (a.x_m == b.x_m && a.z_m < b.z_m);
    };
    std::sort(points.begin(), points.end(), is_before);
    Ring hull;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t first = hull.size();
        for (const PlanePoint& point : points) {
            while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
                hull.pop_back();
            }
            hull.push_back(point);
        }
        hull.pop_back();  // it begins the other half
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

std::vector<Ring> joined_rings(const std::vector<Ring>& rings) {
    std::map<Corner, PlanePoint> points;
    std::map<std::pair<Corner, Corner>, std::size_t> edges;  // and how often each occurs
    for (const Ring& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Corner from = corner_at(ring[i]), to = corner_at(ring[(i + 1) % ring.size()]);
            points.emplace(from, ring[i]);
            if (from == to) {
                continue;
            }
            if (const auto back = edges.find({to, from}); back == edges.end()) {
                ++edges[{from, to}];
            } else if (--back->second == 0) {
                edges.erase(back);
            }
        }
    }
    std::multimap<Corner, Corner> steps;
    for (const auto& [edge, count] : edges) {
        for (std::size_t i = 0; i < count; ++i) {
            steps.emplace(edge);
        }
    }
    std::vector<Ring> joined;
    for (auto& chain : take_chains(steps)) {
        chain.pop_back();  // the first corner again
        Ring ring;
        for (const Corner& corner : chain) {
            ring.push_back(points.at(corner));
        }
        if (ring = straightened(ring); ring.size() > 2) {
            joined.push_back(std::move(ring));
        }
    }
    return joined;
}

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
