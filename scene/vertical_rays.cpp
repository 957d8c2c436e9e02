// Vertical lines through the parts of obstacles, and their shadows on the ground. Every part is convex, so each answer
// is one interval, found in closed form.

#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/base/infinity.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/scene_solids.hpp"
#include "downwash/scene/seen_from_above.hpp"

namespace downwash {
namespace {

constexpr Interval whole_line{-infinity, infinity};

Interval overlap(const Interval& a, const Interval& b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

Interval hull(const Interval& a, const Interval& b) {
    if (a.empty()) {
        return b;
    }
    return b.empty() ? a : Interval{std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// Where |offset + s / per_rate| <= half; per_rate 0 stands for a line along the slab.
Interval within(double offset, double per_rate, double half) {
    if (per_rate == 0) {
        return std::abs(offset) <= half ? whole_line : Interval{};
    }
    const double middle = -offset * per_rate;
    const double reach = half * std::abs(per_rate);
    return {middle - reach, middle + reach};
}

// The stretch of the vertical line through (x, y), all from the part's centre.

Interval vertical(double x, double y, const BoxFromAbove& box) {
    Interval stretch = whole_line;
    for (const Slab& face : box.faces) {
        stretch = overlap(stretch, within(face.gx * x + face.gy * y, face.per_rise, face.half));
    }
    return stretch;
}

Interval vertical(double x, double y, const SphereFromAbove& sphere) {
    const double square = sphere.radius_square - x * x - y * y;
    if (!(square >= 0)) {
        return {};
    }
    const double half = std::sqrt(square);
    return {-half, half};
}

Interval vertical(double x, double y, const CylinderFromAbove& cylinder) {
    const double along = x * cylinder.along_x + y * cylinder.along_y;
    const double across = y * cylinder.along_x - x * cylinder.along_y;
    const Interval between_ends = within(along * cylinder.level, cylinder.per_upright, cylinder.half_length);
    const double square = cylinder.radius * cylinder.radius - across * across;
    if (cylinder.level == 0) {
        return along * along <= square ? between_ends : Interval{};
    }
    if (!(square >= 0)) {
        return {};
    }
    // |w|^2 - (w . axis)^2 = r^2 for w = (along, across, s), solved for s without cancellation.
    const double middle = along * cylinder.upright * cylinder.per_level;
    const double half = std::sqrt(square) * cylinder.per_level;
    return overlap(between_ends, {middle - half, middle + half});
}

// The stretch of the horizontal line (x, y) + s (dx, dy) inside the shadow.

Interval shadow(double x, double y, double dx, double dy, const BoxFromAbove& box) {
    Interval stretch = whole_line;
    for (const Slab& side : box.shadow) {
        const double per_rate = inverse_or_zero(side.gx * dx + side.gy * dy);
        stretch = overlap(stretch, within(side.gx * x + side.gy * y, per_rate, side.half));
    }
    return stretch;
}

Interval shadow(double x, double y, double dx, double dy, const SphereFromAbove& sphere) {
    const double middle = -(x * dx + y * dy);
    const double across = y * dx - x * dy;
    const double square = sphere.radius_square - across * across;
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
Interval shadow(double x_world, double y_world, double dx, double dy, const CylinderFromAbove& cylinder) {
    const double x = x_world * cylinder.along_x + y_world * cylinder.along_y;
    const double y = y_world * cylinder.along_x - x_world * cylinder.along_y;
    const double line_x = dx * cylinder.along_x + dy * cylinder.along_y;
    const double line_y = dy * cylinder.along_x - dx * cylinder.along_y;
    const double radius = cylinder.radius;
    if (cylinder.level == 0) {
        return inside_ellipse(x, y, line_x, line_y, radius, 1);
    }
    const double half_length = cylinder.half_length * cylinder.level;
    const double flat = std::abs(cylinder.upright);
    const Interval middle =
        overlap(within(x, inverse_or_zero(line_x), half_length), within(y, inverse_or_zero(line_y), radius));
    if (flat == 0) {
        return middle;
    }
    const Interval far_end = inside_ellipse(x - half_length, y, line_x, line_y, radius, flat);
    const Interval near_end = inside_ellipse(x + half_length, y, line_x, line_y, radius, flat);
    return hull(middle, hull(far_end, near_end));
}

/// Faces that turn up, or down, by more than a negligible tilt.
void add_box_faces(const Vector3& size_m, const Vector3& center_m, const Matrix3& r, bool is_from_above,
                   std::pmr::vector<Scene::Face>& faces) {
    constexpr double negligible_share = 1e-12;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(std::abs(r[2][axis]) > negligible_share)) {
            continue;
        }
        const double out = 0.5 * size_m[axis] * ((r[2][axis] > 0) == is_from_above ? 1 : -1);
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        Scene::Face face{{}, 4};
        constexpr std::array<std::array<double, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                face.corners_m[i][k] = center_m[k] + out * r[k][axis] + signs[i][0] * 0.5 * size_m[u] * r[k][u] +
                                       signs[i][1] * 0.5 * size_m[v] * r[k][v];
            }
        }
        faces.push_back(face);
    }
}

/// Asks one part: of_form(centre, form) for what is seen from above as a primitive, else of_triangle(triangle).
template <class OfForm, class OfTriangle>
Interval of_part(const Parts& parts, std::size_t part, const OfForm& of_form, const OfTriangle& of_triangle) {
    return parts.visit(
        part,
        [&](std::size_t i) {
            return std::visit([&](const auto& form) { return of_form(parts.primitive_centers_m[i], form); },
                              parts.primitives_from_above[i]);
        },
        [&](const OctreeBox& box, const Placement& placement) {
            return of_form(box.center_m, box_from_above(Box{box.size_m}, placement));
        },
        of_triangle);
}

}  // namespace

Interval Scene::vertical_extent(std::size_t part, double x_m, double y_m) const noexcept {
    return of_part(
        solids_->parts, part,
        [&](const Vector3& center_m, const auto& form) {
            const Interval stretch = vertical(x_m - center_m[0], y_m - center_m[1], form);
            return stretch.low <= stretch.high ? Interval{center_m[2] + stretch.low, center_m[2] + stretch.high}
                                               : Interval{};
        },
        [&](const Triangle& triangle) { return downwash::vertical_extent(triangle, x_m, y_m); });
}

Interval Scene::shadow_on_line(std::size_t part, double px_m, double py_m, double dx, double dy) const noexcept {
    return of_part(
        solids_->parts, part,
        [&](const Vector3& center_m, const auto& form) {
            return shadow(px_m - center_m[0], py_m - center_m[1], dx, dy, form);
        },
        [&](const Triangle& triangle) { return downwash::shadow_on_line(triangle, px_m, py_m, dx, dy); });
}

bool Scene::add_faces(std::size_t part, bool is_from_above, std::pmr::vector<Face>& faces) const {
    const auto of_box = [&](const Vector3& size_m, const Vector3& center_m, const Matrix3& rotation) {
        add_box_faces(size_m, center_m, rotation, is_from_above, faces);
        return true;
    };
    const Parts& parts = solids_->parts;
    return parts.visit(
        part,
        [&](std::size_t i) {
            const auto* box = std::get_if<Box>(&parts.primitives[i]);
            return box != nullptr &&
                   of_box(box->size_m, parts.primitive_centers_m[i], parts.primitive_placements[i].rotation);
        },
        [&](const OctreeBox& box, const Placement& placement) {
            return of_box(box.size_m, box.center_m, placement.rotation);
        },
        [&](const Triangle& triangle) {
            if (downwash::has_shadow(triangle)) {
                faces.push_back({{triangle[0], triangle[1], triangle[2]}, 3});
            }
            return true;
        });
}

bool Scene::has_shadow(std::size_t part) const noexcept {
    const std::size_t first = solids_->parts.first_triangle();
    return part < first || downwash::has_shadow(solids_->parts.triangles[part - first]);
}

bool Scene::is_level(std::size_t part) const noexcept {
    const Parts& parts = solids_->parts;
    return parts.visit(
        part, [&](std::size_t i) { return has_level_faces(parts.primitives_from_above[i]); },
        [](const OctreeBox& box, const Placement& placement) {
            return has_level_faces(box_from_above(Box{box.size_m}, placement));
        },
        [](const Triangle& triangle) { return downwash::is_level(triangle); });
}

}  // namespace downwash
