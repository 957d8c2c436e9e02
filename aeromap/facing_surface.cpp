#include "downwash/aeromap/facing_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "downwash/base/infinity.hpp"

namespace downwash {
namespace {

/// A box shows as many faces to one side.
constexpr std::size_t max_planes = 3;

/// The gap of a plane along a chord: that at u = 0 and its rate.
struct SurfaceLine {
    double gap_m, rate;
};

/// Those of a part that are seen from the rotor.
const std::vector<Footprint::Plane>& planes(const DiscQuery& query, const Footprint& part) {
    return query.side == Side::below ? part.upper_planes : part.lower_planes;
}

/// A height over (x, y) as a gap, negative on the other side.
double plane_gap_m(const DiscQuery& query, const Footprint::Plane& plane, double x, double y) {
    const double above_m = plane.z_m + plane.gx * x + plane.gy * y - query.hub_m[2];
    return query.side == Side::below ? -above_m : above_m;
}

double plane_rate(const DiscQuery& query, const Footprint::Plane& plane, double dx, double dy) {
    const double rise = plane.gx * dx + plane.gy * dy;
    return query.side == Side::below ? -rise : rise;
}

struct Kinks {
    const DiscQuery& query;
    const ChordFrame& frame;
    const Footprint& part;
    std::pmr::vector<double>& breaks;

    void add_of_planes() {
        for (const Footprint::Plane& plane : planes(query, part)) {
            const double along = plane_rate(query, plane, frame.du_x, frame.du_y);
            const double across = plane_rate(query, plane, -frame.du_y, frame.du_x);
            if (std::abs(along) < 0.5 * std::abs(across)) {
                add_inside((query.kink_m() - plane_gap_m(query, plane, frame.hub_x_m, frame.hub_y_m)) / across);
            }
        }
    }

    void add_of_sphere() {
        const OutlineEllipse& circle = part.outline.ellipses.front();
        add_across(frame.u_of(circle.x, circle.y), frame.v_of(circle.x, circle.y), circle.across_m);
    }

    /// Adds the surface of a cylinder that lies along the chords.
    void add_of_cylinder() {
        const OutlineSegment& one = part.outline.segments[0];
        const OutlineSegment& other = part.outline.segments[1];
        const double one_v = frame.v_of(one.ax, one.ay);
        const double other_v = frame.v_of(other.ax, other.ay);
        const double from = frame.u_of(one.ax, one.ay);
        const double to = frame.u_of(one.bx, one.by);
        const double inset = 0.01 * (to - from);  // at the very ends there may be nothing
        const double u = std::clamp(0.0, std::min(from + inset, to - inset), std::max(from + inset, to - inset));
        add_across(u, 0.5 * (one_v + other_v), 0.5 * std::abs(other_v - one_v));
    }

    /// Across a round part the gap is c - b sqrt(radius^2 - w^2), w from its middle; two of its values tell b and c.
    void add_across(double u, double middle_v, double radius_m) {
        const auto gap_m = [&](double w) {
            return gap_at(query, part, frame.x_of(u, middle_v + w), frame.y_of(u, middle_v + w));
        };
        const double in_middle = gap_m(0);
        const double beside = gap_m(0.6 * radius_m);  // where the root is 0.8 of the radius
        if (!(in_middle > 0 && in_middle < query.kink_m() && beside < infinity)) {
            return;
        }
        const double bend = (beside - in_middle) / (1 - 0.8);
        const double root = 1 - (query.kink_m() - in_middle) / bend;
        if (root > 0 && root < 1) {
            const double w = radius_m * std::sqrt((1 - root) * (1 + root));
            add_inside(middle_v - w);
            add_inside(middle_v + w);
        }
    }

    void add_inside(double v) {
        if (std::abs(v) < frame.radius_m) {
            breaks.push_back(v);
        }
    }
};

}  // namespace

double gap_at(const DiscQuery& query, const Footprint& part, double x, double y) {
    const Interval extent = query.scene.vertical_extent(part.part, x, y);
    return extent.empty() ? infinity : query.gap(extent.low, extent.high);
}

bool is_straight(const Footprint& part, const ChordFrame& frame) {
    if (part.has_plane_faces || part.is_level) {
        return true;
    }
    constexpr double negligible = 1e-9;
    const ShadowOutline& outline = part.outline;
    return !outline.segments.empty() &&
           std::abs(frame.du_x * outline.slope_x + frame.du_y * outline.slope_y) < negligible;
}

/// A convex part with plane faces is as far away as the farthest of their planes.
bool add_plane_stretches(const DiscQuery& query, const ChordFrame& frame, const Footprint& part, double v,
                         const Interval& shadow, ChordEnvelope& envelope) {
    const std::vector<Footprint::Plane>& seen = planes(query, part);
    const std::size_t count = seen.size();
    if (count == 0 || count > max_planes) {
        return false;
    }
    std::array<SurfaceLine, max_planes> lines{};
    for (std::size_t i = 0; i < count; ++i) {
        lines[i] = {plane_gap_m(query, seen[i], frame.x_of(0, v), frame.y_of(0, v)),
                    plane_rate(query, seen[i], frame.du_x, frame.du_y)};
    }
    // The line that is farthest at the low end, then those that overtake it, each with a greater rate.
    SurfaceLine line = lines[0];
    for (std::size_t i = 1; i < count; ++i) {
        const double lead = (lines[i].gap_m - line.gap_m) + (lines[i].rate - line.rate) * shadow.low;
        line = lead > 0 ? lines[i] : line;
    }
    std::array<SurfaceStretch, max_planes> stretches{};
    std::size_t stretch_count = 0;
    double from = shadow.low;
    for (std::size_t turn = 0; turn < count && from < shadow.high; ++turn) {
        SurfaceLine next = line;
        double to = shadow.high;
        for (std::size_t i = 0; i < count; ++i) {
            const double gain = lines[i].rate - line.rate;
            if (gain > 0 && line.gap_m - lines[i].gap_m < to * gain) {
                to = std::max(from, (line.gap_m - lines[i].gap_m) / gain);
                next = lines[i];
            }
        }
        if (from < to) {
            const SurfaceStretch stretch{from, to, line.gap_m + line.rate * from, line.gap_m + line.rate * to};
            if (!(stretch.gap_low >= 0 && stretch.gap_high >= 0)) {
                return false;
            }
            stretches[stretch_count++] = stretch;
        }
        from = to;
        line = next;
    }
    for (std::size_t i = 0; i < stretch_count; ++i) {
        envelope.add(stretches[i]);
    }
    return true;
}

void add_kinks(const DiscQuery& query, const ChordFrame& frame, const Footprint& part,
               std::pmr::vector<double>& breaks) {
    Kinks kinks{query, frame, part, breaks};
    if (part.has_plane_faces) {
        kinks.add_of_planes();
    } else if (part.outline.segments.empty()) {
        kinks.add_of_sphere();
    } else if (is_straight(part, frame)) {
        kinks.add_of_cylinder();
    }
}

}  // namespace downwash
