#include "downwash/scene/shadow_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

constexpr double negligible_m = 1e-9;
constexpr double negligible_part = 1e-9;

bool are_close(double ax, double ay, double bx, double by) {
    return std::abs(ax - bx) < negligible_m && std::abs(ay - by) < negligible_m;
}

bool are_same(const OutlineSegment& a, const OutlineSegment& b) {
    return (are_close(a.ax, a.ay, b.ax, b.ay) && are_close(a.bx, a.by, b.bx, b.by)) ||
           (are_close(a.ax, a.ay, b.bx, b.by) && are_close(a.bx, a.by, b.ax, b.ay));
}

/// Upright edges shrink to a point, and edges above each other count once.
void add(ShadowOutline& outline, const OutlineSegment& segment) {
    if (are_close(segment.ax, segment.ay, segment.bx, segment.by)) {
        return;
    }
    const auto known = std::find_if(outline.segments.begin(), outline.segments.end(),
                                    [&](const OutlineSegment& other) { return are_same(segment, other); });
    if (known == outline.segments.end()) {
        outline.segments.push_back(segment);
    } else {
        known->seen_from_above |= segment.seen_from_above;
        known->seen_from_below |= segment.seen_from_below;
    }
}

/// The horizontal part of the steepest local axis, which is the normal of the upper or lower face; of a level box
/// another axis.
void set_slope(ShadowOutline& outline, const Matrix3& r) {
    const auto level_part = [&](std::size_t axis) {
        return std::sqrt(r[0][axis] * r[0][axis] + r[1][axis] * r[1][axis]);
    };
    std::size_t normal = 0;
    for (const std::size_t axis : {1U, 2U}) {
        normal = level_part(axis) < level_part(normal) ? axis : normal;
    }
    const std::size_t chosen = level_part(normal) > negligible_part ? normal : (normal + 1) % 3;
    outline.slope_x = r[0][chosen] / level_part(chosen);
    outline.slope_y = r[1][chosen] / level_part(chosen);
}

ShadowOutline outline_of(const Box& box, const Vector3& center_m, const Placement& placement) {
    ShadowOutline outline;
    const Matrix3& r = placement.rotation;
    set_slope(outline, r);
    const auto corner = [&](const std::array<double, 3>& signs, std::size_t row) {
        double position = center_m[row];
        for (std::size_t k = 0; k < 3; ++k) {
            position += r[row][k] * 0.5 * signs[k] * box.size_m[k];
        }
        return position;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double one : {-1.0, 1.0}) {
            for (const double other : {-1.0, 1.0}) {
                std::array<double, 3> from{};
                from[axis] = -1;
                from[(axis + 1) % 3] = one;
                from[(axis + 2) % 3] = other;
                std::array<double, 3> to = from;
                to[axis] = 1;
                // The two faces that meet in this edge.
                const double rise = one * r[2][(axis + 1) % 3];
                const double other_rise = other * r[2][(axis + 2) % 3];
                add(outline, {corner(from, 0), corner(from, 1), corner(to, 0), corner(to, 1),
                              rise > 0 || other_rise > 0, rise < 0 || other_rise < 0});
            }
        }
    }
    return outline;
}

ShadowOutline outline_of(const Sphere& sphere, const Vector3& center_m, const Placement&) {
    return {1, 0, {}, {{center_m[0], center_m[1], 1, 0, sphere.radius_m, sphere.radius_m, true, true}}};
}

ShadowOutline outline_of(const Cylinder& cylinder, const Vector3& center_m, const Placement& placement) {
    ShadowOutline outline;
    const Vector3& axis = placement.axis_world;
    const double level = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1]);
    const double x = center_m[0];
    const double y = center_m[1];
    const double r = cylinder.radius_m;
    if (level < negligible_part) {
        outline.ellipses.push_back({x, y, 1, 0, r, r, true, true});
        return outline;
    }
    const double ux = axis[0] / level;
    const double uy = axis[1] / level;
    outline.slope_x = -uy;
    outline.slope_y = ux;
    const double half_x = 0.5 * cylinder.length_m * axis[0];
    const double half_y = 0.5 * cylinder.length_m * axis[1];
    for (const double side : {-r, r}) {
        const double px = x - side * uy;
        const double py = y + side * ux;
        add(outline, {px - half_x, py - half_y, px + half_x, py + half_y, true, true});
    }
    for (const double end : {-1.0, 1.0}) {
        const double px = x + end * half_x;
        const double py = y + end * half_y;
        if (std::abs(axis[2]) < negligible_part) {
            add(outline, {px - r * uy, py + r * ux, px + r * uy, py - r * ux, true, true});
        } else {
            outline.ellipses.push_back(
                {px, py, ux, uy, r * std::abs(axis[2]), r, end * axis[2] > 0, end * axis[2] < 0});
        }
    }
    return outline;
}

/// Every edge: where triangles meet, a surface may crease.
ShadowOutline outline_of(const Triangle& t) {
    ShadowOutline outline;
    if (!has_shadow(t)) {
        return outline;
    }
    const Vector3 normal = normal_of(t);
    const double level = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1]);
    if (is_level(t)) {
        const double x = t[1][0] - t[0][0];
        const double y = t[1][1] - t[0][1];
        const double length = std::sqrt(x * x + y * y);
        outline.slope_x = x / length;
        outline.slope_y = y / length;
    } else {
        outline.slope_x = normal[0] / level;
        outline.slope_y = normal[1] / level;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3& a = t[i];
        const Vector3& b = t[(i + 1) % 3];
        outline.segments.push_back({a[0], a[1], b[0], b[1], true, true});
    }
    return outline;
}

}  // namespace

ShadowOutline shadow_outline(const Scene& scene, std::size_t part) {
    const Parts& parts = scene.solids().parts;
    return parts.visit(
        part,
        [&](std::size_t i) {
            return std::visit(
                [&](const auto& shape) {
                    return outline_of(shape, parts.primitive_centers_m[i], parts.primitive_placements[i]);
                },
                parts.primitives[i]);
        },
        [](const OctreeBox& box, const Placement& placement) {
            return outline_of(Box{box.size_m}, box.center_m, placement);
        },
        [](const Triangle& triangle) { return outline_of(triangle); });
}

}  // namespace downwash
