#include "downwash/scene/convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "downwash/base/direction.hpp"

namespace downwash {
namespace {

/// The point of the solid without its ball that lies farthest in `direction`.
Vector3 support(const Convex& convex, const Vector3& direction) {
    Vector3 point = convex.center_m;
    if (convex.is_triangle) {
        const auto farther = [&](const Vector3& a, const Vector3& b) { return dot(a, direction) < dot(b, direction); };
        return point + *std::max_element(convex.half_axes_m.begin(), convex.half_axes_m.end(), farther);
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(convex.segment_count); ++i) {
        const Vector3& axis = convex.half_axes_m[i];
        point = dot(axis, direction) < 0 ? point - axis : point + axis;
    }
    if (convex.disc_radius_m > 0) {
        // Twice, and not for a direction along the normal: what rounding leaves of the normal would leave the disc.
        const Vector3& normal = convex.disc_normal;
        const Vector3 rough = direction - dot(normal, direction) * normal;
        const Vector3 along = rough - dot(normal, rough) * normal;
        const double squared = dot(along, along);
        if (squared > 1e-28 * dot(direction, direction)) {
            point = point + (convex.disc_radius_m / std::sqrt(squared)) * along;
        }
    }
    return point;
}

/// A simplex of up to four points and the point of it that is nearest to the origin.
struct Simplex {
    std::array<Vector3, 4> points{};
    std::size_t size = 0;
    Vector3 nearest{};
    double squared = std::numeric_limits<double>::infinity();  ///< |nearest|^2

    void offer(const Vector3& candidate, std::initializer_list<Vector3> corners) {
        const double candidate_squared = dot(candidate, candidate);
        if (candidate_squared < squared) {
            squared = candidate_squared;
            nearest = candidate;
            size = 0;
            for (const Vector3& corner : corners) {
                points[size++] = corner;
            }
        }
    }
};

void offer_edge(Simplex& best, const Vector3& a, const Vector3& b) {
    const Vector3 ab = b - a;
    const double s = -dot(a, ab);
    const double whole = dot(ab, ab);
    if (s > 0 && s < whole) {
        best.offer(a + (s / whole) * ab, {a, b});
    }
}

void offer_triangle(Simplex& best, const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 ab = b - a;
    const Vector3 ac = c - a;
    const Vector3 normal = cross(ab, ac);
    const double whole = dot(normal, normal);
    const double s = dot(normal, cross(ac, a));
    const double t = dot(normal, cross(a, ab));
    if (s > 0 && t > 0 && s + t < whole) {
        best.offer(a + ((s / whole) * ab + (t / whole) * ac), {a, b, c});
    }
}

bool holds_origin(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    const Vector3 ab = b - a;
    const Vector3 ac = c - a;
    const Vector3 ad = d - a;
    const double whole = dot(ab, cross(ac, ad));
    const double s = -dot(a, cross(ac, ad)) / whole;
    const double t = -dot(ab, cross(a, ad)) / whole;
    const double u = -dot(ab, cross(ac, a)) / whole;
    return s >= 0 && t >= 0 && u >= 0 && s + t + u <= 1;  // false when flat: the comparisons fail on NaN
}

/// Adds a point that lies nearer to the origin than the plane through `simplex.nearest`, and keeps the part of the
/// simplex that holds the new nearest point. That part has the new point as a corner, so the others are not tried.
Simplex advanced(const Simplex& simplex, const Vector3& a) {
    const auto& p = simplex.points;
    Simplex best;
    best.offer(a, {a});
    for (std::size_t i = 0; i < simplex.size; ++i) {
        offer_edge(best, a, p[i]);
    }
    for (std::size_t i = 1; i < simplex.size; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            offer_triangle(best, a, p[i], p[j]);
        }
    }
    if (simplex.size == 3 && holds_origin(a, p[0], p[1], p[2])) {
        best.offer({0, 0, 0}, {a});
    }
    return best;
}

struct Bracket {
    double low, high;
};

/// Encloses the distance of the solids without their balls (Gilbert, Johnson and Keerthi 1988), and stops as soon as
/// it is certainly at least `enough`, certainly below `below`, or known to rounding. Both ends are certain at any
/// time: the nearest point found is a point of the difference of the solids, and the plane across it through the
/// support point has that difference on its far side.
Bracket core_distance(const Convex& a, const Convex& b, double enough, double below) {
    constexpr double tolerance_m = 1e-10;
    constexpr double contact_m = 1e-13;
    constexpr int max_steps = 128;  // a handful for boxes, some ten for round solids
    Vector3 direction = a.center_m - b.center_m;
    if (b.is_triangle) {
        // Its plane often tells that it is far enough.
        const Vector3 normal = cross(b.half_axes_m[1] - b.half_axes_m[0], b.half_axes_m[2] - b.half_axes_m[0]);
        const double side = dot(normal, direction - b.half_axes_m[0]);
        if (side != 0) {
            direction = (side < 0 ? -1.0 : 1.0) * normal;
        }
    }
    double squared = dot(direction, direction);
    if (squared == 0) {
        direction = {1, 0, 0};
        squared = 1;
    }
    Simplex simplex;
    Bracket bracket{0, std::numeric_limits<double>::infinity()};
    for (int step = 0; step < max_steps; ++step) {
        const Vector3 point = support(a, -1.0 * direction) - support(b, direction);
        bracket.low = std::max(bracket.low, dot(direction, point) / std::sqrt(squared));
        if (bracket.low >= enough || bracket.high - bracket.low <= tolerance_m) {
            break;
        }
        const Simplex next = advanced(simplex, point);
        if (!(next.squared < simplex.squared)) {
            break;  // rounding leaves no progress
        }
        simplex = next;
        direction = simplex.nearest;
        squared = simplex.squared;
        bracket.high = std::sqrt(squared);
        if (bracket.high < below || bracket.high <= contact_m) {
            break;
        }
    }
    return bracket;
}

struct ConvexMaker {
    const Vector3& center_m;
    const Placement& placement;

    Vector3 scaled_column(std::size_t k, double scale) const {
        const Matrix3& r = placement.rotation;
        return {scale * r[0][k], scale * r[1][k], scale * r[2][k]};
    }
    Convex operator()(const Box& box) const {
        Convex convex{.center_m = center_m, .segment_count = 3};
        for (std::size_t k = 0; k < 3; ++k) {
            convex.half_axes_m[k] = scaled_column(k, 0.5 * box.size_m[k]);
        }
        return convex;
    }
    Convex operator()(const Cylinder& cylinder) const {
        return {.center_m = center_m,
                .segment_count = 1,
                .half_axes_m = {(0.5 * cylinder.length_m) * placement.axis_world},
                .disc_normal = placement.axis_world,
                .disc_radius_m = cylinder.radius_m};
    }
    Convex operator()(const Sphere& sphere) const { return {.center_m = center_m, .ball_radius_m = sphere.radius_m}; }
    Convex operator()(const Capsule& capsule) const {
        return {.center_m = center_m + placement.rotation * (0.5 * (capsule.from_m + capsule.to_m)),
                .segment_count = 1,
                .half_axes_m = {placement.rotation * (0.5 * (capsule.to_m - capsule.from_m))},
                .ball_radius_m = capsule.radius_m};
    }
};

}  // namespace

Placement placement_of(const Primitive& shape, const Matrix3& rotation) noexcept {
    const auto* cylinder = std::get_if<Cylinder>(&shape);
    const Vector3 axis = cylinder ? unit(cylinder->axis) : Vector3{0, 0, 1};
    return {rotation, rotation * axis};
}

Convex convex_of(const Primitive& shape, const Vector3& center_m, const Placement& placement) {
    return std::visit(ConvexMaker{center_m, placement}, shape);
}

Convex convex_of(const SpaceBodyShape& solid) {
    const auto* cylinder = std::get_if<Cylinder>(&solid.shape);
    const Placement upright{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, cylinder ? unit(cylinder->axis) : Vector3{0, 0, 1}};
    return std::visit(ConvexMaker{solid.center_m, upright}, solid.shape);
}

Vector3 half_extents_m(const Convex& convex) noexcept {
    const double ball = convex.ball_radius_m;
    Vector3 half{ball, ball, ball};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(convex.segment_count); ++i) {
            const double reach = std::abs(convex.half_axes_m[i][k]);
            half[k] = convex.is_triangle ? std::max(half[k], reach) : half[k] + reach;
        }
        if (convex.disc_radius_m > 0) {
            const double b = convex.disc_normal[(k + 1) % 3];
            const double c = convex.disc_normal[(k + 2) % 3];
            half[k] += convex.disc_radius_m * std::sqrt(b * b + c * c);
        }
    }
    return half;
}

double distance_m(const Convex& a, const Convex& b, double enough_m) noexcept {
    const double balls = a.ball_radius_m + b.ball_radius_m;
    return core_distance(a, b, enough_m + balls, 0).low - balls;
}

bool is_nearer_than(const Convex& a, const Convex& b, double margin_m) noexcept {
    const double threshold = margin_m + (a.ball_radius_m + b.ball_radius_m);
    const Bracket core = core_distance(a, b, threshold, threshold);
    return core.low < threshold || core.low <= 0;
}

}  // namespace downwash
