#include "downwash/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "downwash/base/fault.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/solids.hpp"

namespace downwash {
namespace {

constexpr double greatest_angle_rad = 1e5;  // what lane::sin_cos allows

bool is_finite(const Vector3& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Collects the faults of one obstacle under its key.
class Inspection {
 public:
    Inspection(std::string key, std::vector<Fault>& faults) : key_(std::move(key)), faults_(faults) {}

    void operator()(const Box& box) {
        for (const double size : box.size_m) {
            if (!is_length(size)) {
                report(".box.size_m", "must be three finite numbers above 0, the full edge lengths in metres");
                return;
            }
        }
    }
    void operator()(const Cylinder& cylinder) {
        require_length(cylinder.radius_m, ".cylinder.radius_m");
        require_length(cylinder.length_m, ".cylinder.length_m");
        if (!is_finite(cylinder.axis) || cylinder.axis == Vector3{0, 0, 0}) {
            report(".cylinder.axis", "must be three finite numbers that are not all 0, for example [0, 0, 1]");
        }
    }
    void operator()(const Sphere& sphere) { require_length(sphere.radius_m, ".sphere.radius_m"); }

    void placement(const Obstacle& obstacle) {
        if (!is_finite(obstacle.center_m)) {
            report(".center_m", "must be three finite numbers, the position in the world in metres");
        }
        for (const double angle : obstacle.rpy_rad) {
            if (!(std::abs(angle) <= greatest_angle_rad)) {
                report(".rpy_rad", "must be three finite angles of at most 1e5 rad; whole turns can be left out");
                return;
            }
        }
    }

 private:
    static bool is_length(double x) { return std::isfinite(x) && x > 0; }
    void require_length(double x, const char* key) {
        if (!is_length(x)) {
            report(key, "must be a finite length above 0 in metres");
        }
    }
    void report(const char* key, const char* message) { faults_.push_back({key_ + key, message}); }

    std::string key_;
    std::vector<Fault>& faults_;
};

void require_valid(const std::vector<Obstacle>& obstacles) {
    std::vector<Fault> faults;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        Inspection inspect("obstacles[" + std::to_string(i) + "]", faults);
        std::visit(inspect, obstacles[i].shape);
        inspect.placement(obstacles[i]);
    }
    if (!faults.empty()) {
        throw InputError(std::move(faults));
    }
}

Matrix3 rotation_of(const Vector3& rpy_rad) {
    double sr, cr, sp, cp, sy, cy;
    lane::sin_cos(rpy_rad[0], sr, cr);
    lane::sin_cos(rpy_rad[1], sp, cp);
    lane::sin_cos(rpy_rad[2], sy, cy);
    return {{{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
             {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
             {-sp, cp * sr, cp * cr}}};
}

double dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The vector over its length, first scaled so that no square over- or underflows.
Vector3 unit(Vector3 v) {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    for (double& component : v) {
        component /= largest;
    }
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

Placement placement_of(const Obstacle& obstacle) {
    const Matrix3 rotation = rotation_of(obstacle.rpy_rad);
    const auto* cylinder = std::get_if<Cylinder>(&obstacle.shape);
    const Vector3 axis = cylinder ? unit(cylinder->axis) : Vector3{0, 0, 1};
    return {rotation, {dot(rotation[0], axis), dot(rotation[1], axis), dot(rotation[2], axis)}};
}

// Half of a placed shape's extent along the world axis k.
double half_extent(const Box& box, const Placement& placement, std::size_t k) {
    const Vector3& row = placement.rotation[k];
    return 0.5 *
           (std::abs(row[0]) * box.size_m[0] + std::abs(row[1]) * box.size_m[1] + std::abs(row[2]) * box.size_m[2]);
}
double half_extent(const Cylinder& cylinder, const Placement& placement, std::size_t k) {
    const Vector3& axis = placement.axis_world;
    const double b = axis[(k + 1) % 3];
    const double c = axis[(k + 2) % 3];
    return 0.5 * std::abs(axis[k]) * cylinder.length_m + std::sqrt(b * b + c * c) * cylinder.radius_m;
}
double half_extent(const Sphere& sphere, const Placement&, std::size_t) {
    return sphere.radius_m;
}

Scene::Bounds bounds_of(const Obstacle& obstacle, const Placement& placement) {
    Scene::Bounds bounds{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double half =
            std::visit([&](const auto& shape) { return half_extent(shape, placement, k); }, obstacle.shape);
        bounds.low_m[k] = obstacle.center_m[k] - half;
        bounds.high_m[k] = obstacle.center_m[k] + half;
    }
    return bounds;
}

std::unique_ptr<const Scene::Solids> placed(std::vector<Obstacle> obstacles) {
    require_valid(obstacles);
    auto solids = std::make_unique<Scene::Solids>();
    for (const Obstacle& obstacle : obstacles) {
        solids->placements.push_back(placement_of(obstacle));
        solids->bounds.push_back(bounds_of(obstacle, solids->placements.back()));
    }
    solids->obstacles = std::move(obstacles);
    return solids;
}

}  // namespace

Scene::Scene(std::vector<Obstacle> obstacles) : solids_(placed(std::move(obstacles))) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const std::vector<Obstacle>& Scene::obstacles() const noexcept {
    return solids_->obstacles;
}

const Scene::Bounds& Scene::bounds(std::size_t obstacle) const noexcept {
    return solids_->bounds[obstacle];
}

const Scene::Solids& Scene::solids() const noexcept {
    return *solids_;
}

}  // namespace downwash
