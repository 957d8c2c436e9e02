#include "downwash/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/mesh_sides.hpp"
#include "downwash/scene/mesh_surface.hpp"
#include "downwash/scene/octree_boxes.hpp"
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

/// Adds the errors of a shape's sizes to a list, under the shape's key.
struct SizeInspector {
    const std::string& key;
    std::vector<KeyError>& errors;

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
            errors.push_back({key + name, message});
        }
    }
};

void inspect_pose(const Obstacle& obstacle, const std::string& key, std::vector<KeyError>& errors) {
    if (!is_finite(obstacle.center_m)) {
        errors.push_back({key + ".center_m", "must be three finite numbers, the position in the world in metres"});
    }
    const auto is_small = [](double angle_rad) { return std::abs(angle_rad) <= greatest_angle_rad; };
    if (!std::all_of(obstacle.rpy_rad.begin(), obstacle.rpy_rad.end(), is_small)) {
        errors.push_back({key + ".rpy_rad", "must be three angles of at most 1e5 rad; leave out whole turns"});
    }
}

/// Adds the errors of any shape.
struct ShapeInspector {
    const std::string& key;
    std::vector<KeyError>& errors;

    void operator()(const Mesh& mesh) const { inspect(mesh, key, errors); }
    void operator()(const Octomap& octomap) const { inspect(octomap, key, errors); }
    void operator()(const Primitive& primitive) const { inspect(primitive, key, errors); }
};

void require_valid(const std::vector<Obstacle>& obstacles) {
    std::vector<KeyError> errors;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string key = "obstacles[" + std::to_string(i) + "]";
        std::visit(ShapeInspector{key, errors}, obstacles[i].shape);
        inspect_pose(obstacles[i], key, errors);
    }
    if (!errors.empty()) {
        throw InputError(std::move(errors));
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

Vector3 turned(const Matrix3& r, const Vector3& v) {
    return {r[0][0] * v[0] + r[0][1] * v[1] + r[0][2] * v[2], r[1][0] * v[0] + r[1][1] * v[1] + r[1][2] * v[2],
            r[2][0] * v[0] + r[2][1] * v[1] + r[2][2] * v[2]};
}

void widen(Scene::Bounds& bounds, const Scene::Bounds& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        bounds.low_m[k] = std::min(bounds.low_m[k], other.low_m[k]);
        bounds.high_m[k] = std::max(bounds.high_m[k], other.high_m[k]);
    }
}

/// Adds the parts of one obstacle and returns the bounds of them all.
struct PartsMaker {
    const Obstacle& obstacle;
    const std::string& key;
    Scene::Solids& solids;

    Vector3 to_world(const Matrix3& rotation, const Vector3& p_m) const {
        const Vector3 p = turned(rotation, p_m);
        return {obstacle.center_m[0] + p[0], obstacle.center_m[1] + p[1], obstacle.center_m[2] + p[2]};
    }
    void require_room(std::size_t more, const char* name) const {
        if (solids.parts.count() + more > most_pieces) {
            throw InputError({{key + name, "brings the scene above " + std::to_string(most_pieces) +
                                               " triangles and boxes: leave out what the robot cannot reach"}});
        }
    }
    Scene::Bounds operator()(const Primitive& primitive) const {
        solids.parts.add(primitive, obstacle.center_m, placement_of(primitive, rotation_of(obstacle.rpy_rad)));
        return solids.parts.primitive_bounds.back();
    }
    Scene::Bounds operator()(const Octomap& octomap) const {
        const std::vector<LocalBox> boxes = merged_boxes(*octomap.tree);
        require_room(boxes.size(), ".octomap.file");
        Parts& parts = solids.parts;
        const Placement placement = placement_of(Box{}, rotation_of(obstacle.rpy_rad));
        const auto turn = static_cast<std::uint32_t>(parts.octree_placements.size());
        parts.octree_placements.push_back(placement);
        Scene::Bounds bounds = nothing;
        for (const LocalBox& box : boxes) {
            const OctreeBox placed{to_world(placement.rotation, box.center_m), box.size_m, turn};
            parts.octree_boxes.push_back(placed);
            widen(bounds, bounds_of(convex_of(Box{placed.size_m}, placed.center_m, placement)));
        }
        return bounds;
    }
    Scene::Bounds operator()(const Mesh& mesh) const {
        require_room(mesh.surface->triangles.size(), ".mesh.file");
        const MeshSides sides = sides_of(*mesh.surface);
        if (sides.kind == SurfaceKind::contradictory) {
            throw InputError({{key + ".mesh.file",
                               "has triangles that disagree about which side is outside: repair the mesh so that it "
                               "encloses a space, or has a rim and is a sheet"}});
        }
        std::vector<Triangle>& triangles = solids.parts.triangles;
        const Matrix3 rotation = rotation_of(obstacle.rpy_rad);
        const std::size_t first = triangles.size();
        Scene::Bounds bounds = nothing;
        for (Triangle triangle : scaled_triangles(mesh, sides.is_turned)) {
            for (Vector3& corner : triangle) {
                corner = to_world(rotation, corner);
            }
            triangles.push_back(triangle);
            widen(bounds, bounds_of(triangle));
        }
        if (sides.kind == SurfaceKind::solid) {
            solids.closed_surfaces.push_back({first, triangles.size(), bounds});
        }
        return bounds;
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr Scene::Bounds nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
};

std::unique_ptr<const Scene::Solids> placed(std::vector<Obstacle> obstacles) {
    require_valid(obstacles);
    auto solids = std::make_unique<Scene::Solids>();
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string key = "obstacles[" + std::to_string(i) + "]";
        solids->bounds.push_back(std::visit(PartsMaker{obstacles[i], key, *solids}, obstacles[i].shape));
    }
    solids->parts.index();
    solids->obstacles = std::move(obstacles);
    return solids;
}

}  // namespace

void inspect(const Primitive& shape, const std::string& key, std::vector<KeyError>& errors) {
    std::visit(SizeInspector{key, errors}, shape);
}

bool Scene::Solids::is_inside_closed_surface(const Vector3& p_m) const noexcept {
    const auto apart_upwards = [&](const Bounds& box) {
        return std::max({box.low_m[0] - p_m[0], p_m[0] - box.high_m[0], box.low_m[1] - p_m[1], p_m[1] - box.high_m[1],
                         p_m[2] - box.high_m[2]});
    };
    return std::any_of(closed_surfaces.begin(), closed_surfaces.end(), [&](const ClosedSurface& surface) {
        if (apart_upwards(surface.bounds) > 0 || p_m[2] < surface.bounds.low_m[2]) {
            return false;
        }
        int turns = 0;
        parts.any_other(apart_upwards, 0, [&](std::size_t part) {
            const std::size_t triangle = part - parts.first_triangle();  // huge for other parts
            if (triangle >= surface.first && triangle < surface.last) {
                turns += winding_above(parts.triangles[triangle], p_m);
            }
            return false;
        });
        return turns != 0;
    });
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

std::size_t Scene::part_count() const noexcept {
    return solids_->parts.count();
}

std::size_t Scene::primitive_count() const noexcept {
    return solids_->parts.primitives.size();
}

void Scene::add_parts_meeting(const Bounds& box, std::pmr::vector<std::size_t>& parts) const {
    const Parts& all = solids_->parts;
    const auto gap = [&](const Bounds& other) { return gap_m(box, other); };
    all.any_other(gap, 0, [&](std::size_t part) {
        if (gap(all.bounds(part)) <= 0) {
            parts.push_back(part);
        }
        return false;
    });
}

bool Scene::is_triangle(std::size_t part) const noexcept {
    return part >= solids_->parts.first_triangle();
}

Scene::Bounds Scene::part_bounds(std::size_t part) const noexcept {
    return solids_->parts.bounds(part);
}

const Scene::Solids& Scene::solids() const noexcept {
    return *solids_;
}

}  // namespace downwash
