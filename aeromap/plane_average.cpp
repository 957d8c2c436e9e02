#include "downwash/aeromap/disc_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <numbers>
#include <vector>

#include "downwash/aeromap/gauss_rule.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

using std::numbers::pi;

/// The average over a disc of what depends on the distance from a line through its middle: distances in radii, weights
/// that add up to 1. Gauss and Chebyshev's rule of the second kind, exact for polynomials up to the 23rd power.
const std::array<GaussNode, 12>& across_disc() {
    static const std::array<GaussNode, 12> rule = [] {
        std::array<GaussNode, 12> nodes{};
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double parts = static_cast<double>(nodes.size() + 1);
            const auto [sine, cosine] = lane::sin_cos(pi * static_cast<double>(i + 1) / parts);
            nodes[i] = {cosine, 2 * sine * sine / parts};
        }
        return nodes;
    }();
    return rule;
}

/// Whether an edge reaches into the disc.
bool reaches_into(const OutlineSegment& edge, double x, double y, double radius) {
    const double ax = edge.ax - x;
    const double ay = edge.ay - y;
    const double dx = edge.bx - edge.ax;
    const double dy = edge.by - edge.ay;
    const double part = std::clamp(-(ax * dx + ay * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    const double nearest_x = ax + part * dx;
    const double nearest_y = ay + part * dy;
    return nearest_x * nearest_x + nearest_y * nearest_y < radius * radius;
}

}  // namespace

std::optional<PlaneCover> plane_cover(const DiscQuery& query, const Footprint& footprint) {
    const auto& [x, y, z] = query.hub_m;
    const double r = query.radius_m;
    const bool is_below = query.side == Side::below;
    const auto is_seen_in_disc = [&, hub_x = x, hub_y = y](const OutlineSegment& edge) {
        return (is_below ? edge.seen_from_above : edge.seen_from_below) && reaches_into(edge, hub_x, hub_y, r);
    };
    const ShadowOutline& outline = footprint.outline;
    if (!outline.ellipses.empty() || outline.segments.empty() ||
        std::any_of(outline.segments.begin(), outline.segments.end(), is_seen_in_disc) || !footprint.has_plane_faces) {
        return {};
    }
    // Without an edge in the disc all of it sees the face that its middle sees, or all of it none.
    const auto signed_gap = [&](const Interval& extent) {
        return is_below ? query.hub_m[2] - extent.high : extent.low - query.hub_m[2];
    };
    const Interval middle = query.scene.vertical_extent(footprint.part, x, y);
    const Interval ahead = query.scene.vertical_extent(footprint.part, x + 0.5 * r, y);
    const Interval beside = query.scene.vertical_extent(footprint.part, x, y + 0.5 * r);
    if (middle.empty() || ahead.empty() || beside.empty()) {
        return {};
    }
    const double gap = signed_gap(middle);
    const double range_x = 2 * (signed_gap(ahead) - gap);
    const double range_y = 2 * (signed_gap(beside) - gap);
    const PlaneCover cover{gap, std::sqrt(range_x * range_x + range_y * range_y)};
    return cover.gap_m >= cover.gap_range_m ? std::optional(cover) : std::nullopt;
}

double plane_average(const DiscQuery& query, const PlaneCover& cover) {
    if (!(cover.gap_range_m > 0)) {
        return query.factor(cover.gap_m);
    }
    // The model's cap is a kink which the rule must not run across.
    const double kink = std::clamp((query.kink_m() - cover.gap_m) / cover.gap_range_m, -1.0, 1.0);
    if (std::abs(kink) == 1) {
        double sum = 0;
        for (const GaussNode& node : across_disc()) {
            sum += node.weight * query.factor(cover.gap_m + cover.gap_range_m * node.position);
        }
        return sum;
    }
    // At a distance r sin t from the middle a chord is 2 r cos t long, and dv = r cos t dt.
    const auto weighted = [&](double t) {
        const auto [sine, cosine] = lane::sin_cos(t);
        return query.factor(cover.gap_m + cover.gap_range_m * sine) * cosine * cosine;
    };
    const double split = lane::atan2(kink, std::sqrt((1 - kink) * (1 + kink)));
    return (integrate(plain_12, -0.5 * pi, split, weighted) + integrate(plain_12, split, 0.5 * pi, weighted)) *
           (2 / pi);
}

}  // namespace downwash
