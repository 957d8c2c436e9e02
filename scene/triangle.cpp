#include "downwash/scene/triangle.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/infinity.hpp"

namespace downwash {
namespace {

/// Sine of an angle too small to matter: over 100 m it moves a surface by 1e-10 m.
constexpr double negligible_slope = 1e-12;

bool is_upright(const Vector3& normal) {
    return !(std::abs(normal[2]) > negligible_slope * std::sqrt(dot(normal, normal)));
}

/// Height of the triangle's plane, kept between the lowest and the highest corner. @pre not upright
double height_at(const Triangle& t, const Vector3& normal, double x, double y) {
    const auto [low, high] = std::minmax({t[0][2], t[1][2], t[2][2]});
    const double rise = normal[0] * (x - t[0][0]) + normal[1] * (y - t[0][1]);
    return std::clamp(t[0][2] - rise / normal[2], low, high);
}

/// How far (x, y) lies left of the edge from a to b, seen from above, times the edge's length.
double left_of(const Vector3& a, const Vector3& b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

/// Whether the level ray from (x, y) along x crosses the edge: 1 when the edge goes up in y, -1 when down, 0 when it
/// does not. An edge and its reverse give opposite answers, to the bit.
int crossing(const Vector3& a, const Vector3& b, double x, double y) {
    const bool goes_up = a[1] <= y && b[1] > y;
    const bool goes_down = b[1] <= y && a[1] > y;
    if (!goes_up && !goes_down) {
        return 0;
    }
    const Vector3& low = goes_up ? a : b;
    const Vector3& high = goes_up ? b : a;
    const double part = (y - low[1]) / (high[1] - low[1]);
    if (!(x < low[0] + part * (high[0] - low[0]))) {
        return 0;
    }
    return goes_up ? 1 : -1;
}

}  // namespace

Vector3 normal_of(const Triangle& triangle) noexcept {
    return cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
}

Convex convex_of(const Triangle& triangle) noexcept {
    const BoundingBox bounds = bounds_of(triangle);
    const Vector3 center = 0.5 * (bounds.low_m + bounds.high_m);
    return {.center_m = center,
            .segment_count = 3,
            .is_triangle = true,
            .half_axes_m = {triangle[0] - center, triangle[1] - center, triangle[2] - center}};
}

BoundingBox bounds_of(const Triangle& triangle) noexcept {
    BoundingBox bounds{triangle[0], triangle[0]};
    bounds.include({triangle[1], triangle[1]});
    bounds.include({triangle[2], triangle[2]});
    return bounds;
}

bool has_shadow(const Triangle& triangle) noexcept {
    return !is_upright(normal_of(triangle));
}

bool is_level(const Triangle& triangle) noexcept {
    const Vector3 normal = normal_of(triangle);
    const double tilt = std::max(std::abs(normal[0]), std::abs(normal[1]));
    return tilt <= negligible_slope * std::abs(normal[2]);
}

Interval vertical_extent(const Triangle& triangle, double x_m, double y_m) noexcept {
    const Vector3 normal = normal_of(triangle);
    if (is_upright(normal)) {
        return {};
    }
    const double turn = normal[2] > 0 ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i) {
        if (turn * left_of(triangle[i], triangle[(i + 1) % 3], x_m, y_m) < 0) {
            return {};
        }
    }
    const double height = height_at(triangle, normal, x_m, y_m);
    return {height, height};
}

Interval shadow_on_line(const Triangle& triangle, double px_m, double py_m, double dx, double dy) noexcept {
    const Vector3 normal = normal_of(triangle);
    if (is_upright(normal)) {
        return {};
    }
    const double turn = normal[2] > 0 ? 1 : -1;
    Interval stretch{-infinity, infinity};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3& a = triangle[i];
        const Vector3& b = triangle[(i + 1) % 3];
        const double inside = turn * left_of(a, b, px_m, py_m);
        const double rate = turn * ((b[0] - a[0]) * dy - (b[1] - a[1]) * dx);
        if (rate > 0) {
            stretch.low = std::max(stretch.low, -inside / rate);
        } else if (rate < 0) {
            stretch.high = std::min(stretch.high, -inside / rate);
        } else if (inside < 0) {
            return {};
        }
    }
    return stretch;
}

int winding_above(const Triangle& triangle, const Vector3& p_m) noexcept {
    int turns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        turns += crossing(triangle[i], triangle[(i + 1) % 3], p_m[0], p_m[1]);
    }
    if (turns == 0) {
        return 0;
    }
    const Vector3 normal = normal_of(triangle);
    const double height = normal[2] == 0 ? triangle[0][2] : height_at(triangle, normal, p_m[0], p_m[1]);
    return height > p_m[2] ? turns : 0;
}

}  // namespace downwash
