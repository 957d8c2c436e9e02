#include "downwash/report/flow_figure.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace downwash {
namespace {

/// The unit direction of the flow; empty where there is none.
std::optional<PlanePoint> direction(const PlanarVelocity& velocity, const PlanePoint& p) {
    const auto [u, w] = velocity(p.x_m, p.z_m);
    const double speed = std::sqrt(u * u + w * w);
    if (!(speed > 0 && std::isfinite(speed))) {
        return std::nullopt;
    }
    return PlanePoint{u / speed, w / speed};
}

PlanePoint moved(const PlanePoint& p, double length, const PlanePoint& along) {
    return {p.x_m + length * along.x_m, p.z_m + length * along.z_m};
}

std::optional<PlanePoint> next_point(const PlanarVelocity& velocity, const PlanePoint& p, double step) {
    const auto k1 = direction(velocity, p);
    const auto k2 = k1 ? direction(velocity, moved(p, step / 2, *k1)) : k1;
    const auto k3 = k2 ? direction(velocity, moved(p, step / 2, *k2)) : k2;
    const auto k4 = k3 ? direction(velocity, moved(p, step, *k3)) : k3;
    if (!k4) {
        return std::nullopt;
    }
    return moved(p, step / 6,
                 {k1->x_m + 2 * (k2->x_m + k3->x_m) + k4->x_m, k1->z_m + 2 * (k2->z_m + k3->z_m) + k4->z_m});
}

}  // namespace

std::vector<PlanePoint> streamline(const PlanarVelocity& velocity, const PlanePoint& start, const Bounds& extent,
                                   double step) {
    constexpr std::size_t max_points = 10001;
    const auto is_shown = [&](const PlanePoint& p) {
        return p.x_m >= extent.x_low_m && p.x_m <= extent.x_high_m && p.z_m >= extent.z_low_m &&
               p.z_m <= extent.z_high_m;
    };
    std::vector<PlanePoint> points{start};
    while (points.size() < max_points && is_shown(points.back())) {
        const auto next = next_point(velocity, points.back(), step);
        // At a stagnation point the line would oscillate: a step that hardly gains length ends it.
        constexpr double min_gain = 0.5;
        if (!next || std::hypot(next->x_m - points.back().x_m, next->z_m - points.back().z_m) < min_gain * step) {
            break;
        }
        points.push_back(*next);
    }
    return points;
}

FieldFigure flow_figure(const PlanarVelocity& velocity, const Bounds& extent, const std::vector<PlanePoint>& starts,
                        ColorScale scale) {
    constexpr double steps_across = 500;
    FieldFigure figure;
    figure.extent = extent;
    figure.scale = std::move(scale);
    figure.undefined_name = "no finite velocity";
    figure.value = [velocity](double x_m, double z_m) {
        const double w = velocity(x_m, z_m)[1];
        return std::isfinite(w) ? w : std::numeric_limits<double>::quiet_NaN();
    };
    FigureLines lines{"streamlines", {}, {40, 40, 40}, 1.2, LineDash::solid, true};
    const double step = std::hypot(extent.x_high_m - extent.x_low_m, extent.z_high_m - extent.z_low_m) / steps_across;
    for (const PlanePoint& start : starts) {
        lines.pieces.push_back(streamline(velocity, start, extent, step));
    }
    figure.lines.push_back(std::move(lines));
    return figure;
}

}  // namespace downwash
