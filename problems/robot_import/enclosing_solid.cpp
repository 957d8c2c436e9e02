#include "downwash/robot_import/enclosing_solid.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "downwash/base/direction.hpp"
#include "downwash/robot_import/rigid_transform.hpp"

namespace downwash::robot_import {
namespace {

using Points = std::vector<Vector3>;

constexpr double least_thickness_m = 1e-3;  // of a sheet

/// Directions that fill the sphere evenly: a Fibonacci spiral.
Points spread_directions() {
    constexpr int count = 400;
    constexpr double golden_rad = 2.399963229728653;
    Points directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2.0 * i + 1) / count, across = std::sqrt(1 - z * z);
        directions.push_back({across * std::cos(golden_rad * i), across * std::sin(golden_rad * i), z});
    }
    return directions;
}

double extent_of(const Points& points, const Vector3& direction) {
    double extent = -std::numeric_limits<double>::infinity();
    for (const Vector3& point : points) {
        extent = std::max(extent, dot(point, direction));
    }
    return extent;
}

/// The points that are farthest along many directions: enough to compare solids by.
Points outermost(const Points& points, const Points& directions) {
    if (points.size() <= directions.size()) {
        return points;
    }
    std::vector<const Vector3*> found;
    for (const Vector3& direction : directions) {
        found.push_back(&*std::ranges::max_element(
            points, {}, [&direction](const Vector3& point) { return dot(point, direction); }));
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    Points chosen;
    for (const Vector3* point : found) {
        chosen.push_back(*point);
    }
    return chosen;
}

/// The middle of the least ball around points, to a few thousandths of its radius (Badoiu and Clarkson 2003): towards
/// the farthest point, by less each time. The middle of points that are symmetric is exact.
Vector3 middle_of_ball(const Points& points) {
    constexpr int rounds = 300;
    const BoundingBox bounds = bounds_around(points);
    Vector3 at = 0.5 * (bounds.low_m + bounds.high_m), best = at;
    double best_square = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= rounds; ++i) {
        const auto away = [&at](const Vector3& point) { return dot(point - at, point - at); };
        const Vector3& farthest = *std::ranges::max_element(points, {}, away);
        if (const double square = away(farthest); square < best_square) {
            best_square = square;
            best = at;
        }
        at = at + (1.0 / (i + 1)) * (farthest - at);
    }
    return best;
}

double farthest_from(const Points& points, const Vector3& place) {
    double square = 0;
    for (const Vector3& point : points) {
        square = std::max(square, dot(point - place, point - place));
    }
    return std::sqrt(square);
}

Points flattened(const Points& points, const Vector3& axis) {
    Points flat;
    for (const Vector3& point : points) {
        flat.push_back(point - dot(point, axis) * axis);
    }
    return flat;
}

/// Where the axis of a cylinder around points meets the plane across it through the origin.
Vector3 middle_across(const Points& points, const Vector3& axis) {
    const Vector3 middle = middle_of_ball(flattened(points, axis));
    return middle - dot(middle, axis) * axis;
}

SpaceBodyShape box_around(const Points& points) {
    const BoundingBox bounds = bounds_around(points);
    Vector3 size_m = bounds.high_m - bounds.low_m;
    for (double& edge_m : size_m) {
        edge_m = std::max(edge_m, least_thickness_m);
    }
    return {Box{size_m}, 0.5 * (bounds.low_m + bounds.high_m)};
}

/// @param about the middle of the sphere
SpaceBodyShape sphere_around(const Points& points, const Vector3& about) {
    return {Sphere{std::max(farthest_from(points, about), 0.5 * least_thickness_m)}, about};
}

/// @param about middle_across()
SpaceBodyShape cylinder_around(const Points& points, const Vector3& axis, const Vector3& about) {
    const double high = extent_of(points, axis), low = -extent_of(points, -1.0 * axis);
    const double radius_m = farthest_from(flattened(points, axis), about);
    return {Cylinder{std::max(radius_m, 0.5 * least_thickness_m), std::max(high - low, least_thickness_m), axis},
            about + (0.5 * (low + high)) * axis};
}

/// A capsule as wide as that cylinder. Its ends are where every point is just within one of its halves of balls.
SpaceBodyShape capsule_around(const Points& points, const Vector3& axis, const Vector3& about) {
    const double radius_m = std::max(farthest_from(flattened(points, axis), about), 0.5 * least_thickness_m);
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (const Vector3& point : points) {
        const double along = dot(point, axis);
        const Vector3 off = point - along * axis - about;
        const double cap = std::sqrt(std::max(0.0, radius_m * radius_m - dot(off, off)));
        from = std::min(from, along + cap);
        to = std::max(to, along - cap);
    }
    if (from > to) {  // any place between holds them all
        from = to = 0.5 * (from + to);
    }
    const double middle = 0.5 * (from + to);
    return {Capsule{radius_m, (from - middle) * axis, (to - middle) * axis}, about + middle * axis};
}

using Along = SpaceBodyShape (*)(const Points&, const Vector3&, const Vector3&);

double volume_along(Along solid, const Points& points, const Vector3& axis) {
    return volume_m3(solid(points, axis, middle_across(points, axis)).shape);
}

/// An axis along which such a solid is small: the best of some, then turned by smaller and smaller steps.
Vector3 best_axis(Along solid, const Points& points, const Points& candidates) {
    Vector3 best = candidates[0];
    double least = volume_along(solid, points, best);
    const auto take = [&](const Vector3& axis) {
        constexpr double gain = 1e-6;  // an axis of the model stays as it is
        const double volume = volume_along(solid, points, axis);
        if (volume >= (1 - gain) * least) {
            return false;
        }
        least = volume;
        best = axis;
        return true;
    };
    for (const Vector3& axis : candidates) {
        take(axis);
    }
    constexpr double first_rad = 0.3, last_rad = 0.005;
    for (double step = first_rad; step > last_rad;) {
        const Vector3 aside = across(best), other = cross(best, aside);
        const bool is_better = take(unit(best + step * aside)) || take(unit(best - step * aside)) ||
                               take(unit(best + step * other)) || take(unit(best - step * other));
        step = is_better ? step : 0.5 * step;
    }
    return best;
}

/// Directions in which points spread most, most evenly and least.
Points principal_axes(const Points& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Vector3& point : points) {
        mean += Eigen::Map<const Eigen::Vector3d>(point.data()) / static_cast<double>(points.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3& point : points) {
        const Eigen::Vector3d from = Eigen::Map<const Eigen::Vector3d>(point.data()) - mean;
        spread += from * from.transpose();
    }
    const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    Points found;
    for (int k = 0; k < 3; ++k) {
        found.push_back({axes(0, k), axes(1, k), axes(2, k)});
    }
    return found;
}

struct ExtentOf {
    const Vector3& direction;

    double operator()(const Box& box) const {
        return 0.5 * (std::abs(direction[0]) * box.size_m[0] + std::abs(direction[1]) * box.size_m[1] +
                      std::abs(direction[2]) * box.size_m[2]);
    }
    double operator()(const Cylinder& cylinder) const {
        const double along = std::abs(dot(direction, unit(cylinder.axis)));
        return 0.5 * cylinder.length_m * along + cylinder.radius_m * std::sqrt(std::max(0.0, 1 - along * along));
    }
    double operator()(const Sphere& sphere) const { return sphere.radius_m; }
    double operator()(const Capsule& capsule) const {
        return std::max(dot(direction, capsule.from_m), dot(direction, capsule.to_m)) + capsule.radius_m;
    }
};

double excess_m(const SpaceBodyShape& body, const Points& points, const Points& directions) {
    double most = 0;
    for (const Vector3& direction : directions) {
        most = std::max(most, dot(direction, body.center_m) + std::visit(ExtentOf{direction}, body.shape) -
                                  extent_of(points, direction));
    }
    return most;
}

struct VolumeOf {
    double operator()(const Box& box) const { return box.size_m[0] * box.size_m[1] * box.size_m[2]; }
    double operator()(const Cylinder& cylinder) const {
        return std::numbers::pi * cylinder.radius_m * cylinder.radius_m * cylinder.length_m;
    }
    double operator()(const Sphere& sphere) const {
        return 4.0 / 3.0 * std::numbers::pi * std::pow(sphere.radius_m, 3);
    }
    double operator()(const Capsule& capsule) const {
        const double length_m = length_of(capsule.to_m - capsule.from_m);
        return std::numbers::pi * capsule.radius_m * capsule.radius_m * length_m + (*this)(Sphere{capsule.radius_m});
    }
};

}  // namespace

BoundingBox bounds_around(const std::vector<Vector3>& points_m) {
    BoundingBox bounds{points_m[0], points_m[0]};
    for (const Vector3& point : points_m) {
        bounds.include({point, point});
    }
    return bounds;
}

double volume_m3(const SpaceShape& shape) {
    return std::visit(VolumeOf{}, shape);
}

const char* name_of(const SpaceShape& shape) noexcept {
    constexpr std::array names{"box", "cylinder", "sphere", "capsule"};
    static_assert(names.size() == std::variant_size_v<SpaceShape>);
    return names[shape.index()];
}

EnclosingSolid least_solid_around(const std::vector<Vector3>& points_m, const std::vector<Vector3>& axes) {
    const Points directions = spread_directions();
    const Points outer = outermost(points_m, directions);
    Points candidates{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    candidates.insert(candidates.end(), axes.begin(), axes.end());
    for (const Vector3& axis : principal_axes(outer)) {
        candidates.push_back(axis);
    }
    // Sizes come from all points, so that none is outside.
    SpaceBodyShape best = box_around(points_m);
    const auto offer = [&best](const SpaceBodyShape& other) {
        constexpr double enough = 0.99;
        if (volume_m3(other.shape) < enough * volume_m3(best.shape)) {
            best = other;
        }
    };
    offer(sphere_around(points_m, middle_of_ball(outer)));
    for (const Along solid : {&cylinder_around, &capsule_around}) {
        const Vector3 axis = best_axis(solid, outer, candidates);
        offer(solid(points_m, axis, middle_across(outer, axis)));
    }
    return {best, excess_m(best, points_m, directions)};
}

}  // namespace downwash::robot_import
