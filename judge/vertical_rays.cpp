#include "downwash/judge/vertical_rays.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "downwash/base/infinity.hpp"
#include "downwash/judge/placement.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

constexpr std::size_t max_columns = 4'000'000;
/// A part over more columns is wide.
constexpr std::size_t max_columns_of_part = 256;

/// The stretch of a line o + t d in which |component k| is at most half.
void cut(const Vector3d& o, const Vector3d& d, int k, double half, double& from, double& to) {
    if (std::abs(d[k]) < 1e-12) {
        if (std::abs(o[k]) > half) {
            from = infinity;
        }
        return;
    }
    const double one = (-half - o[k]) / d[k];
    const double other = (half - o[k]) / d[k];
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
}

/// The stretch of a line o + t d in which the first `dimensions` components are within a radius of the origin.
void cut_round(const Vector3d& o, const Vector3d& d, int dimensions, double radius, double& from, double& to) {
    const double a = d.head(dimensions).squaredNorm();
    const double b = o.head(dimensions).dot(d.head(dimensions));
    const double c = o.head(dimensions).squaredNorm() - radius * radius;
    if (a < 1e-24) {
        if (c > 0) {
            from = infinity;
        }
        return;
    }
    const double root = b * b - a * c;
    if (root < 0) {
        from = infinity;
        return;
    }
    from = std::max(from, (-b - std::sqrt(root)) / a);
    to = std::min(to, (-b + std::sqrt(root)) / a);
}

struct Triangle {
    std::array<Vector3d, 3> corners_m;
};

/// A box, a cylinder along z or a ball in a frame: all of them by half their size.
struct Solid {
    enum class Kind : std::uint8_t { box, cylinder, ball } kind;
    Eigen::Isometry3d to_local;
    Vector3d half_m;
};

using ShapePart = std::variant<Triangle, Solid>;

/// Where a vertical line is in a part: nowhere, if low is above high.
struct Heights {
    double low_m, high_m;
};

Heights heights(const Triangle& triangle, double x_m, double y_m) {
    const auto& [a, b, c] = triangle.corners_m;
    const double doubled = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (std::abs(doubled) < 1e-14) {
        return {infinity, -infinity};
    }
    const double of_b = ((x_m - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y_m - a.y())) / doubled;
    const double of_c = ((b.x() - a.x()) * (y_m - a.y()) - (x_m - a.x()) * (b.y() - a.y())) / doubled;
    if (of_b < 0 || of_c < 0 || of_b + of_c > 1) {
        return {infinity, -infinity};
    }
    const double z_m = a.z() + of_b * (b.z() - a.z()) + of_c * (c.z() - a.z());
    return {z_m, z_m};
}

Heights heights(const Solid& solid, double x_m, double y_m) {
    const Vector3d o = solid.to_local * Vector3d(x_m, y_m, 0);
    const Vector3d d = solid.to_local.linear().col(2);
    double from = -infinity;
    double to = infinity;
    switch (solid.kind) {
        case Solid::Kind::box:
            for (int k = 0; k < 3; ++k) {
                cut(o, d, k, solid.half_m[k], from, to);
            }
            break;
        case Solid::Kind::cylinder:
            cut_round(o, d, 2, solid.half_m.x(), from, to);
            cut(o, d, 2, solid.half_m.z(), from, to);
            break;
        case Solid::Kind::ball:
            cut_round(o, d, 3, solid.half_m.x(), from, to);
            break;
    }
    return {from, to};
}

}  // namespace

struct VerticalRays::Parts {
    std::vector<ShapePart> parts;
    std::vector<std::array<double, 4>> extents_m;  ///< of each part: from x, y to x, y
    std::vector<std::uint32_t> wide;               ///< parts over so many columns that every ray asks them
    double x_low_m = 0, y_low_m = 0, column_m = 1;
    std::size_t columns_x = 0, columns_y = 0;
    std::vector<std::uint32_t> starts;      ///< of each column in `in_columns`; behind the last one, the count
    std::vector<std::uint32_t> in_columns;  ///< parts, column by column

    void add(const ShapePart& part, const Vector3d& low_m, const Vector3d& high_m) {
        parts.push_back(part);
        extents_m.push_back({low_m.x(), low_m.y(), high_m.x(), high_m.y()});
    }
    void sort_into_columns(double side_m);
};

namespace {

/// Adds what a shape consists of, in a frame.
template <class Parts>
struct PartsOf {
    Parts& rays;
    Eigen::Isometry3d pose;

    void operator()(const Box& box) const { add(Solid::Kind::box, pose, 0.5 * vector_of(box.size_m)); }
    void operator()(const Sphere& sphere) const { add(Solid::Kind::ball, pose, Vector3d::Constant(sphere.radius_m)); }
    void operator()(const Cylinder& cylinder) const {
        Eigen::Isometry3d turned = pose;
        turned.rotate(turn_from_z(vector_of(cylinder.axis)));
        add(Solid::Kind::cylinder, turned, {cylinder.radius_m, cylinder.radius_m, 0.5 * cylinder.length_m});
    }
    void operator()(const Mesh& mesh) const {
        for (const auto& triangle : mesh.surface->triangles) {
            Triangle placed;
            for (std::size_t i = 0; i < 3; ++i) {
                placed.corners_m[i] = pose * vector_of(local_m(mesh, mesh.surface->vertices_m[triangle[i]]));
            }
            const auto& [a, b, c] = placed.corners_m;
            rays.add(placed, a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c));
        }
    }
    void operator()(const Octomap& octomap) const {
        for_each_solid_box(octomap, [this](const LocalBox& box) {
            Eigen::Isometry3d placed = pose;
            placed.translate(vector_of(box.center_m));
            add(Solid::Kind::box, placed, 0.5 * vector_of(box.size_m));
        });
    }

    void add(Solid::Kind kind, const Eigen::Isometry3d& at, const Vector3d& half_m) const {
        const Vector3d reach = at.linear().cwiseAbs() * half_m;  // of the box around
        rays.add(Solid{kind, at.inverse(), half_m}, at.translation() - reach, at.translation() + reach);
    }
};

}  // namespace

VerticalRays::VerticalRays(const std::vector<Obstacle>& obstacles, double column_m) {
    auto parts = std::make_shared<Parts>();
    for (const Obstacle& obstacle : obstacles) {
        std::visit(PartsOf<Parts>{*parts, pose_of(obstacle)}, obstacle.shape);
    }
    parts->sort_into_columns(column_m);
    parts_ = std::move(parts);
}

void VerticalRays::Parts::sort_into_columns(double side_m) {
    column_m = side_m;
    if (parts.empty()) {
        return;
    }
    // The grid holds what is not wide.
    double x_high_m = -infinity;
    double y_high_m = -infinity;
    x_low_m = y_low_m = infinity;
    std::vector<std::uint32_t> narrow;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        const auto& [x_low, y_low, x_high, y_high] = extents_m[i];
        if (((x_high - x_low) / side_m + 1) * ((y_high - y_low) / side_m + 1) >
            static_cast<double>(max_columns_of_part)) {
            wide.push_back(i);
            continue;
        }
        narrow.push_back(i);
        x_low_m = std::min(x_low_m, x_low);
        y_low_m = std::min(y_low_m, y_low);
        x_high_m = std::max(x_high_m, x_high);
        y_high_m = std::max(y_high_m, y_high);
    }
    if (narrow.empty()) {
        return;
    }
    while (((x_high_m - x_low_m) / column_m + 1) * ((y_high_m - y_low_m) / column_m + 1) >
           static_cast<double>(max_columns)) {
        column_m *= 2;
    }
    columns_x = static_cast<std::size_t>((x_high_m - x_low_m) / column_m) + 1;
    columns_y = static_cast<std::size_t>((y_high_m - y_low_m) / column_m) + 1;
    const auto each_column = [&](std::uint32_t part, const auto& visit) {
        const auto& [x_low, y_low, x_high, y_high] = extents_m[part];
        const auto number = [&](double offset_m, std::size_t count) {
            return std::min(static_cast<std::size_t>(std::max(0.0, offset_m) / column_m), count - 1);
        };
        for (std::size_t j = number(y_low - y_low_m, columns_y); j <= number(y_high - y_low_m, columns_y); ++j) {
            for (std::size_t i = number(x_low - x_low_m, columns_x); i <= number(x_high - x_low_m, columns_x); ++i) {
                visit(j * columns_x + i);
            }
        }
    };
    starts.assign(columns_x * columns_y + 1, 0);
    for (const std::uint32_t part : narrow) {
        each_column(part, [&](std::size_t column) { ++starts[column + 1]; });
    }
    for (std::size_t i = 1; i < starts.size(); ++i) {
        starts[i] += starts[i - 1];
    }
    in_columns.resize(starts.back());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for (const std::uint32_t part : narrow) {
        each_column(part, [&](std::size_t column) { in_columns[next[column]++] = part; });
    }
}

VerticalRays::Gaps VerticalRays::gaps(double x_m, double y_m, double z_m) const {
    const Parts& all = *parts_;
    Gaps gaps{infinity, infinity};
    const auto ask = [&](std::uint32_t i) {
        const Heights at = std::visit([&](const auto& part) { return heights(part, x_m, y_m); }, all.parts[i]);
        if (at.low_m > at.high_m) {
            return;
        }
        if (at.low_m <= z_m) {
            gaps.below_m = std::min(gaps.below_m, std::max(0.0, z_m - at.high_m));
        }
        if (at.high_m >= z_m) {
            gaps.above_m = std::min(gaps.above_m, std::max(0.0, at.low_m - z_m));
        }
    };
    std::for_each(all.wide.begin(), all.wide.end(), ask);
    const double i = std::floor((x_m - all.x_low_m) / all.column_m);
    const double j = std::floor((y_m - all.y_low_m) / all.column_m);
    if (i >= 0 && j >= 0 && i < static_cast<double>(all.columns_x) && j < static_cast<double>(all.columns_y)) {
        const std::size_t column = static_cast<std::size_t>(j) * all.columns_x + static_cast<std::size_t>(i);
        std::for_each(all.in_columns.begin() + all.starts[column], all.in_columns.begin() + all.starts[column + 1],
                      ask);
    }
    return gaps;
}

}  // namespace downwash::judge
