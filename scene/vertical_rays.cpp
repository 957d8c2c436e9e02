// Vertical lines through the obstacles, and their shadows on the ground. Every obstacle is convex, so each answer is
// one interval, found in closed form.

#include <algorithm>
#include <cmath>
#include <limits>

#include "downwash/scene/scene.hpp"
#include "downwash/scene/solids.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Sine of an angle too small to matter: over 100 m it moves a surface by 1e-10 m.
constexpr double negligible_tilt = 1e-12;

Interval whole_line() {
    return {-infinity, infinity};
}

Interval overlap(const Interval& a, const Interval& b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

Interval hull(const Interval& a, const Interval& b) {
    if (a.empty()) {
        return b;
    }
    return b.empty() ? a : Interval{std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// Where |offset + rate s| <= half.
Interval slab(double offset, double rate, double half) {
    if (rate == 0) {
        return std::abs(offset) <= half ? whole_line() : Interval{};
    }
    const double one = (-half - offset) / rate;
    const double other = (half - offset) / rate;
    return {std::min(one, other), std::max(one, other)};
}

double without_negligible(double sine) {
    return std::abs(sine) < negligible_tilt ? 0 : sine;
}

/// An obstacle and the line's point, relative to its centre.
struct Query {
    const Placement& placement;
    double x, y;
};

// The stretch of a vertical line, as heights above the obstacle's centre.

Interval vertical(const Query& query, const Box& box) {
    Interval stretch = whole_line();
    const Matrix3& r = query.placement.rotation;
    for (std::size_t i = 0; i < 3; ++i) {
        const double offset = query.x * r[0][i] + query.y * r[1][i];
        stretch = overlap(stretch, slab(offset, without_negligible(r[2][i]), 0.5 * box.size_m[i]));
    }
    return stretch;
}

Interval vertical(const Query& query, const Sphere& sphere) {
    const double square = sphere.radius_m * sphere.radius_m - query.x * query.x - query.y * query.y;
    if (!(square >= 0)) {
        return {};
    }
    const double half = std::sqrt(square);
    return {-half, half};
}

/// A cylinder seen from above: `along` is the horizontal direction of its axis, `level` and `upright` are the axis'
/// horizontal and vertical parts.
struct AxisFromAbove {
    double along_x, along_y;
    double level, upright;
};

AxisFromAbove from_above(const Vector3& axis) {
    const double level = without_negligible(std::sqrt(axis[0] * axis[0] + axis[1] * axis[1]));
    if (level == 0) {
        return {1, 0, 0, axis[2]};
    }
    return {axis[0] / level, axis[1] / level, level, without_negligible(axis[2])};
}

Interval vertical(const Query& query, const Cylinder& cylinder) {
    const AxisFromAbove axis = from_above(query.placement.axis_world);
    const double along = query.x * axis.along_x + query.y * axis.along_y;
    const double across = query.y * axis.along_x - query.x * axis.along_y;
    const Interval between_ends = slab(along * axis.level, axis.upright, 0.5 * cylinder.length_m);
    const double square = cylinder.radius_m * cylinder.radius_m - across * across;
    if (axis.level == 0) {
        return along * along <= square ? between_ends : Interval{};
    }
    if (!(square >= 0)) {
        return {};
    }
    // |w|^2 - (w . axis)^2 = r^2 for w = (along, across, s), solved for s without cancellation.
    const double middle = along * axis.upright / axis.level;
    const double half = std::sqrt(square) / axis.level;
    return overlap(between_ends, {middle - half, middle + half});
}

// The stretch of the horizontal line (x, y) + s (dx, dy) inside the shadow.

/// The shadow of a box is the sum of three segments: a polygon bounded by up to three pairs of parallel lines.
Interval shadow(const Query& query, double dx, double dy, const Box& box) {
    const Matrix3& r = query.placement.rotation;
    Interval stretch = whole_line();
    for (std::size_t i = 0; i < 3; ++i) {
        const double normal_x = -without_negligible(r[1][i]);
        const double normal_y = without_negligible(r[0][i]);
        double half = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            half += std::abs(normal_x * r[0][k] + normal_y * r[1][k]) * 0.5 * box.size_m[k];
        }
        stretch = overlap(stretch, slab(normal_x * query.x + normal_y * query.y, normal_x * dx + normal_y * dy, half));
    }
    return stretch;
}

Interval shadow(const Query& query, double dx, double dy, const Sphere& sphere) {
    const double middle = -(query.x * dx + query.y * dy);
    const double across = query.y * dx - query.x * dy;
    const double square = sphere.radius_m * sphere.radius_m - across * across;
    if (!(square >= 0)) {
        return {};
    }
    const double half = std::sqrt(square);
    return {middle - half, middle + half};
}

/// Inside the ellipse around the origin with semi-axes `flat` * radius along x and radius along y.
Interval inside_ellipse(double x, double y, double dx, double dy, double radius, double flat) {
    const double squeeze = flat * flat;
    const double a = dx * dx + squeeze * dy * dy;
    const double across = x * dy - y * dx;
    const double square = radius * radius * a - across * across;
    if (a == 0 || !(square >= 0)) {
        return {};
    }
    const double middle = -(x * dx + squeeze * y * dy) / a;
    const double half = flat * std::sqrt(square) / a;
    return {middle - half, middle + half};
}

/// The shadow of a cylinder is the rectangle under its axis plane with the shadows of its ends, two ellipses.
Interval shadow(const Query& query, double dx, double dy, const Cylinder& cylinder) {
    const AxisFromAbove axis = from_above(query.placement.axis_world);
    const double x = query.x * axis.along_x + query.y * axis.along_y;
    const double y = query.y * axis.along_x - query.x * axis.along_y;
    const double line_x = dx * axis.along_x + dy * axis.along_y;
    const double line_y = dy * axis.along_x - dx * axis.along_y;
    const double half_length = 0.5 * cylinder.length_m * axis.level;
    const double flat = std::abs(axis.upright);
    const Interval middle = overlap(slab(x, line_x, half_length), slab(y, line_y, cylinder.radius_m));
    const Interval far_end = inside_ellipse(x - half_length, y, line_x, line_y, cylinder.radius_m, flat);
    const Interval near_end = inside_ellipse(x + half_length, y, line_x, line_y, cylinder.radius_m, flat);
    return hull(middle, hull(far_end, near_end));
}

bool has_level_faces(const Placement& placement, const Box&) {
    const Vector3& rises = placement.rotation[2];
    return std::count_if(rises.begin(), rises.end(), [](double rise) { return without_negligible(rise) == 0; }) == 2;
}
bool has_level_faces(const Placement& placement, const Cylinder&) {
    return from_above(placement.axis_world).level == 0;
}
bool has_level_faces(const Placement&, const Sphere&) {
    return false;
}

}  // namespace

Interval Scene::vertical_extent(std::size_t obstacle, double x_m, double y_m) const noexcept {
    const Obstacle& solid = solids_->obstacles[obstacle];
    const Query query{solids_->placements[obstacle], x_m - solid.center_m[0], y_m - solid.center_m[1]};
    const Interval stretch = std::visit([&](const auto& shape) { return vertical(query, shape); }, solid.shape);
    if (!(stretch.low <= stretch.high)) {
        return {};
    }
    return {solid.center_m[2] + stretch.low, solid.center_m[2] + stretch.high};
}

Interval Scene::shadow_on_line(std::size_t obstacle, double px_m, double py_m, double dx, double dy) const noexcept {
    const Obstacle& solid = solids_->obstacles[obstacle];
    const Query query{solids_->placements[obstacle], px_m - solid.center_m[0], py_m - solid.center_m[1]};
    return std::visit([&](const auto& shape) { return shadow(query, dx, dy, shape); }, solid.shape);
}

bool Scene::is_level(std::size_t obstacle) const noexcept {
    const Placement& placement = solids_->placements[obstacle];
    return std::visit([&](const auto& shape) { return has_level_faces(placement, shape); },
                      solids_->obstacles[obstacle].shape);
}

}  // namespace downwash
