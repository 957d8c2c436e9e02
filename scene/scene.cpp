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

bool is_length(double x) {
    return std::isfinite(x) && x > 0;
}

/// Adds the faults of a shape's sizes to a list, under the shape's key.
struct SizeInspector {
    const std::string& key;
    std::vector<Fault>& faults;

    void operator()(const Box& box) const {
        const auto& [x, y, z] = box.size_m;
        require(is_length(x) && is_length(y) && is_length(z), ".box.size_m",
                "must be three finite numbers above 0, the full edge lengths in metres");
    }
    void operator()(const Cylinder& cylinder) const {
        require(is_length(cylinder.radius_m), ".cylinder.radius_m", "must be a finite length above 0 in metres");
        require(is_length(cylinder.length_m), ".cylinder.length_m", "must be a finite length above 0 in metres");
        require(is_finite(cylinder.axis) && cylinder.axis != Vector3{0, 0, 0}, ".cylinder.axis",
                "must be three finite numbers that are not all 0, for example [0, 0, 1]");
    }
    void operator()(const Sphere& sphere) const {
        require(is_length(sphere.radius_m), ".sphere.radius_m", "must be a finite length above 0 in metres");
    }
    void require(bool holds, const char* name, const char* message) const {
        if (!holds) {
            faults.push_back({key + name, message});
        }
    }
};

void inspect_pose(const Obstacle& obstacle, const std::string& key, std::vector<Fault>& faults) {
    if (!is_finite(obstacle.center_m)) {
        faults.push_back({key + ".center_m", "must be three finite numbers, the position in the world in metres"});
    }
    const auto is_small = [](double angle_rad) { return std::abs(angle_rad) <= greatest_angle_rad; };
    if (!std::all_of(obstacle.rpy_rad.begin(), obstacle.rpy_rad.end(), is_small)) {
        faults.push_back({key + ".rpy_rad", "must be three angles of at most 1e5 rad; leave out whole turns"});
    }
}

void require_valid(const std::vector<Obstacle>& obstacles) {
    std::vector<Fault> faults;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string key = "obstacles[" + std::to_string(i) + "]";
        if (const auto primitive = primitive_of(obstacles[i].shape)) {
            inspect(*primitive, key, faults);
        } else {
            faults.push_back({key, "is a mesh or an octree, which a scene cannot hold yet"});
        }
        inspect_pose(obstacles[i], key, faults);
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

std::unique_ptr<const Scene::Solids> placed(std::vector<Obstacle> obstacles) {
    require_valid(obstacles);
    auto solids = std::make_unique<Scene::Solids>();
    for (const Obstacle& obstacle : obstacles) {
        const Primitive primitive = *primitive_of(obstacle.shape);
        const Placement placement = placement_of(primitive, rotation_of(obstacle.rpy_rad));
        const Convex convex = convex_of(primitive, obstacle.center_m, placement);
        solids->primitives.push_back(primitive);
        solids->placements.push_back(placement);
        solids->convexes.push_back(convex);
        solids->seen_from_above.push_back(seen_from_above(primitive, placement));
        solids->bounds.push_back(bounds_of(convex));
    }
    solids->obstacles = std::move(obstacles);
    return solids;
}

}  // namespace

void inspect(const Primitive& shape, const std::string& key, std::vector<Fault>& faults) {
    std::visit(SizeInspector{key, faults}, shape);
}

std::optional<Primitive> primitive_of(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        return *box;
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
        return *cylinder;
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        return *sphere;
    }
    return std::nullopt;
}

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
