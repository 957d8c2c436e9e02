#include "downwash/aeromap/outline_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace downwash {
namespace {

/// A position (u, v), or a unit vector.
using Pair = std::array<double, 2>;

constexpr double c1 = 0.92387953251128675613;  // cosines of 22.5, 45 and 67.5 degrees
constexpr double c2 = 0.70710678118654752440;
constexpr double c3 = 0.38268343236508977173;
constexpr std::array cosines{1.0, c1, c2, c3, 0.0, -c3, -c2, -c1, -1.0, -c1, -c2, -c3, 0.0, c3, c2, c1};
constexpr auto sixteen_directions = [] {
    std::array<Pair, 16> directions{};
    for (std::size_t i = 0; i < directions.size(); ++i) {
        directions[i] = {cosines[i], cosines[(i + 12) % 16]};
    }
    return directions;
}();

Pair halfway(const Pair& a, const Pair& b) {
    const double u = a[0] + b[0];
    const double v = a[1] + b[1];
    const double length = std::sqrt(u * u + v * v);
    return {u / length, v / length};
}

/// Edges on the far side of an obstacle are hidden behind it.
template <class Edge>
bool is_seen(const Edge& edge, Side side) {
    return side == Side::below ? edge.seen_from_above : edge.seen_from_below;
}

/// An ellipse in the frame of the chords.
struct LocalEllipse {
    LocalEllipse(const ChordFrame& frame, const OutlineEllipse& ellipse)
        : cu(frame.u_of(ellipse.x, ellipse.y)),
          cv(frame.v_of(ellipse.x, ellipse.y)),
          eu(ellipse.ux * frame.du_x + ellipse.uy * frame.du_y),
          ev(ellipse.uy * frame.du_x - ellipse.ux * frame.du_y),
          along(ellipse.along_m),
          across(ellipse.across_m) {}

    /// The point of the ellipse that belongs to a direction of the unit circle.
    [[nodiscard]] Pair point(const Pair& d) const {
        return {cu + along * d[0] * eu - across * d[1] * ev, cv + along * d[0] * ev + across * d[1] * eu};
    }

    double cu, cv;         ///< centre
    double eu, ev;         ///< unit direction of the semi-axis `along`
    double along, across;  ///< semi-axes
};

struct Breaks {
    const ChordFrame& frame;
    std::pmr::vector<double>& breaks;

    /// At its ends inside the disc, and where it crosses the rim.
    void add(const OutlineSegment& segment) {
        const double au = frame.u_of(segment.ax, segment.ay);
        const double av = frame.v_of(segment.ax, segment.ay);
        const double du = frame.u_of(segment.bx, segment.by) - au;
        const double dv = frame.v_of(segment.bx, segment.by) - av;
        const double square = du * du + dv * dv;
        const double along = -(au * du + av * dv);
        const double across = au * dv - av * du;
        const double root = frame.radius_m * frame.radius_m * square - across * across;
        if (!(root > 0)) {
            return;
        }
        add_inside(au, av);
        add_inside(au + du, av + dv);
        for (const double s : {(along - std::sqrt(root)) / square, (along + std::sqrt(root)) / square}) {
            if (s > 0 && s < 1) {
                add_on_rim(av + s * dv);
            }
        }
    }

    /// At its first and last chord, and where it crosses the rim.
    void add(const LocalEllipse& e) {
        const double along = e.along * e.ev;
        const double across = e.across * e.eu;
        const double reach = std::sqrt(along * along + across * across);
        if (reach > 0) {
            const double shift = (e.along * along * e.eu - e.across * across * e.ev) / reach;
            add_inside(e.cu + shift, e.cv + reach);
            add_inside(e.cu - shift, e.cv - reach);
        }
        const double largest = std::max(e.along, e.across);
        const double distance = std::sqrt(e.cu * e.cu + e.cv * e.cv);
        if (distance - largest < frame.radius_m && distance + largest > frame.radius_m) {
            add_rim_crossings(e);
        }
    }

    /// Walks once around the ellipse in sixteen steps and halves those that cross the rim.
    void add_rim_crossings(const LocalEllipse& ellipse) {
        const auto is_inside = [&](const Pair& d) {
            const Pair p = ellipse.point(d);
            return p[0] * p[0] + p[1] * p[1] < frame.radius_m * frame.radius_m;
        };
        Pair last = sixteen_directions.back();
        bool was_inside = is_inside(last);
        for (const Pair& next : sixteen_directions) {
            const bool now_inside = is_inside(next);
            if (now_inside != was_inside) {
                Pair a = last;
                Pair b = next;
                for (int halving = 0; halving < 12; ++halving) {
                    const Pair middle = halfway(a, b);
                    (is_inside(middle) == was_inside ? a : b) = middle;
                }
                add_on_rim(ellipse.point(a)[1]);
            }
            last = next;
            was_inside = now_inside;
        }
    }

    void add_inside(double u, double v) {
        if (u * u + v * v < frame.radius_m * frame.radius_m) {
            breaks.push_back(v);
        }
    }
    void add_on_rim(double v) { breaks.push_back(std::clamp(v, -frame.radius_m, frame.radius_m)); }
};

}  // namespace

void add_breaks(const ChordFrame& frame, Side side, const ShadowOutline& outline, std::pmr::vector<double>& breaks) {
    Breaks all{frame, breaks};
    for (const OutlineSegment& segment : outline.segments) {
        if (is_seen(segment, side)) {
            all.add(segment);
        }
    }
    for (const OutlineEllipse& ellipse : outline.ellipses) {  // of the far ends, half belongs to the shadow's rim
        all.add(LocalEllipse(frame, ellipse));
    }
}

void add_crossings(const ChordFrame& frame, const ShadowOutline& one, const ShadowOutline& other,
                   std::pmr::vector<double>& breaks) {
    for (const OutlineSegment& a : one.segments) {
        const double ax = a.bx - a.ax;
        const double ay = a.by - a.ay;
        for (const OutlineSegment& b : other.segments) {
            const double bx = b.bx - b.ax;
            const double by = b.by - b.ay;
            const double cross = ax * by - ay * bx;
            const double part = ((b.ax - a.ax) * by - (b.ay - a.ay) * bx) / cross;  // not finite for parallels
            const double x = a.ax + part * ax;
            const double y = a.ay + part * ay;
            const double u = frame.u_of(x, y);
            const double v = frame.v_of(x, y);
            if (u * u + v * v < frame.radius_m * frame.radius_m) {
                breaks.push_back(v);
            }
        }
    }
}

void add_creases(const ChordFrame& frame, Side side, const ShadowOutline& outline, double v, const Interval& stretch,
                 std::pmr::vector<double>& cuts) {
    const auto add = [&](double u) {
        if (stretch.low < u && u < stretch.high) {
            cuts.push_back(u);
        }
    };
    for (const OutlineSegment& segment : outline.segments) {
        if (is_seen(segment, side)) {
            const double a = frame.v_of(segment.ax, segment.ay) - v;
            const double b = frame.v_of(segment.bx, segment.by) - v;
            if ((a < 0) != (b < 0)) {
                const double part = a / (a - b);
                add(frame.u_of(segment.ax + part * (segment.bx - segment.ax),
                               segment.ay + part * (segment.by - segment.ay)));
            }
        }
    }
    for (const OutlineEllipse& ellipse : outline.ellipses) {
        if (is_seen(ellipse, side)) {
            // Stretched into the unit circle: |p + u d| = 1, p from the centre to the chord's middle.
            const LocalEllipse e(frame, ellipse);
            const double px = (-e.cu * e.eu + (v - e.cv) * e.ev) / e.along;
            const double py = (e.cu * e.ev + (v - e.cv) * e.eu) / e.across;
            const double dx = e.eu / e.along;
            const double dy = -e.ev / e.across;
            const double square = dx * dx + dy * dy;
            const double middle = -(px * dx + py * dy) / square;
            const double root = square - (px * dy - py * dx) * (px * dy - py * dx);
            if (root > 0) {
                add(middle - std::sqrt(root) / square);
                add(middle + std::sqrt(root) / square);
            }
        }
    }
}

}  // namespace downwash
