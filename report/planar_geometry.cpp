#include "downwash/report/planar_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "downwash/report/chains.hpp"

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

}  // namespace

// Andrew's monotone chain.
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

}  // namespace downwash
