#include "downwash/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/mesh_sides.hpp"
#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/scene/octree_boxes.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

constexpr double max_angle_rad = 1e5;  // what lane::sin_cos allows

bool is_length(double x) {
    return std::isfinite(x) && x > 0;
}

/// Farther from its own origin no corner is of use, and squares stay finite.
constexpr double farthest_m = 1e6;

Triangle corners_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const auto corner = [&](std::size_t i) { return local_m(mesh, mesh.surface->vertices_m[triangle[i]]); };
    return {corner(0), corner(1), corner(2)};
}

bool is_near(const Vector3& p_m) {
    return std::all_of(p_m.begin(), p_m.end(), [](double x) { return std::abs(x) <= farthest_m; });
}

/// What to do about a mesh that lies too far from its origin; nothing if it is too large besides.
std::string remedy_for_far(const Mesh& mesh) {
    BoundingBox bounds{{1, 1, 1}, {-1, -1, -1}};
    for (const auto& triangle : mesh.surface->triangles) {
        for (const Vector3& p_m : corners_of(mesh, triangle)) {
            if (!is_finite(p_m)) {
                return "";
            }
            bounds = bounds.low_m[0] > bounds.high_m[0] ? BoundingBox{p_m, p_m} : bounds;
            bounds.include({p_m, p_m});
        }
    }
    const Vector3 middle_m = bounds.low_m + 0.5 * (bounds.high_m - bounds.low_m);
    if (!is_near(bounds.low_m - middle_m) || !is_near(bounds.high_m - middle_m)) {
        return "";
    }
    std::string offset;
    for (std::size_t k = 0; k < 3; ++k) {
        offset += (k > 0 ? ", " : "") + to_text(std::round(mesh.offset_m[k] + middle_m[k]));
    }
    return "; an offset brings map coordinates there: expected for example offset_m: [" + offset + "]";
}

bool has_area(const Triangle& triangle) {
    return normal_of(triangle) != Vector3{};
}

/// Adds what is wrong with a shape to a list, under the shape's key.
struct ShapeInspector {
    const std::string& key;
    std::vector<KeyError>& errors;

    void operator()(const Box& box) const {
        const auto& [x, y, z] = box.size_m;
        require(is_length(x) && is_length(y) && is_length(z), ".box.size_m",
                "must be three finite numbers above 0, the full edge lengths in metres");
    }
    void operator()(const Cylinder& cylinder) const {
        require_length(cylinder.radius_m, ".cylinder.radius_m");
        require_length(cylinder.length_m, ".cylinder.length_m");
        require(is_finite(cylinder.axis) && cylinder.axis != Vector3{0, 0, 0}, ".cylinder.axis",
                "must be three finite numbers that are not all 0, for example [0, 0, 1]");
    }
    void operator()(const Sphere& sphere) const { require_length(sphere.radius_m, ".sphere.radius_m"); }
    void operator()(const Mesh& mesh) const {
        const bool has_scale =
            require(std::isfinite(mesh.scale) && mesh.scale > 0, ".mesh.scale", "must be a finite number above 0");
        const bool has_offset = require(is_finite(mesh.offset_m), ".mesh.offset_m", "must be three finite numbers");
        if (!has_scale || !has_offset ||
            !require(mesh.surface != nullptr, ".mesh.file", "must have been read: there is no surface")) {
            return;
        }
        const TriangleMesh& surface = *mesh.surface;
        const auto is_vertex = [&](const Vector3& v) { return is_near(local_m(mesh, v)); };
        const auto is_known = [&](const std::array<std::uint32_t, 3>& triangle) {
            return std::all_of(triangle.begin(), triangle.end(),
                               [&](std::uint32_t corner) { return corner < surface.vertices_m.size(); });
        };
        const auto has_extent = [&](const std::array<std::uint32_t, 3>& triangle) {
            return has_area(corners_of(mesh, triangle));
        };
        const auto& triangles = surface.triangles;
        const auto far_corner = [&]() -> const Vector3* {
            for (const auto& triangle : triangles) {
                for (const std::uint32_t corner : triangle) {
                    if (!is_vertex(surface.vertices_m[corner])) {
                        return &surface.vertices_m[corner];
                    }
                }
            }
            return nullptr;
        };
        if (require_pieces(triangles.size(), "triangles", ".mesh.file") &&
            require(std::all_of(triangles.begin(), triangles.end(), is_known), ".mesh.file",
                    "has a triangle with a corner that is not among its vertices")) {
            if (const Vector3* const corner = far_corner()) {
                require(false, ".mesh.file",
                        (mesh.file.empty() ? "" : "'" + mesh.file + "' ") + "has the corner [" +
                            joined(*corner, ", ", [](double x) { return to_text(x, 12); }) +
                            "], which is not finite or, once scaled, farther than 1e6 m from its origin" +
                            remedy_for_far(mesh));
                return;
            }
            require(std::any_of(triangles.begin(), triangles.end(), has_extent), ".mesh.file",
                    "has no triangle with an area");
        }
    }
    void operator()(const Octomap& octomap) const {
        if (!require(octomap.tree != nullptr, ".octomap.file", "must have been read: there is no octree")) {
            return;
        }
        const auto& cubes = octomap.tree->cubes;
        const bool is_filled = octomap.unknown == UnknownSpace::occupied;
        const auto is_sound = [](const OccupiedCube& cube) {
            return is_near(cube.center_local_m) && cube.side_m > 0 && cube.side_m <= farthest_m;
        };
        require(!is_filled || octomap.tree->lists_unseen, ".octomap.unknown",
                "is occupied, and the unseen space of the file has more than " + std::to_string(max_pieces) +
                    " pieces: write the octree with coarser leaves") &&
            require(solid_box_count(octomap) > 0, ".octomap.file", "has no occupied cube") &&
            require_pieces(cubes.size(), "occupied cubes", ".octomap.file") &&
            require(std::all_of(cubes.begin(), cubes.end(), is_sound), ".octomap.file",
                    "has a cube with a centre or side that is not finite, or beyond 1e6 m");
    }

    bool require(bool holds, const char* name, const std::string& message) const {
        if (!holds) {
            errors.push_back({key + name, message});
        }
        return holds;
    }
    void require_length(double length_m, const char* name) const {
        require(is_length(length_m), name, "must be a finite length above 0 in metres");
    }
    bool require_pieces(std::size_t count, const std::string& pieces, const char* name) const {
        return require(
            count <= max_pieces, name,
            "has " + std::to_string(count) + " " + pieces + ": at most " + std::to_string(max_pieces) + " are allowed");
    }
};

/// Adds the triangles of the sheets of a mesh, or those of its solids, that have an area.
void add_triangles(const Mesh& mesh, const MeshSides& sides, bool are_sheets, std::vector<Triangle>& all) {
    const auto& triangles = mesh.surface->triangles;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (sides.is_repeated[i] || sides.is_sheet[i] != are_sheets) {
            continue;
        }
        Triangle corners = corners_of(mesh, triangles[i]);
        if (has_area(corners)) {
            if (sides.is_turned[i]) {
                std::swap(corners[1], corners[2]);
            }
            all.push_back(corners);
        }
    }
}

void inspect_pose(const Obstacle& obstacle, const std::string& key, std::vector<KeyError>& errors) {
    if (!is_finite(obstacle.center_world_m)) {
        errors.push_back({key + ".center_m", "must be three finite numbers, the position in the world in metres"});
    }
    const auto is_small = [](double angle_rad) { return std::abs(angle_rad) <= max_angle_rad; };
    if (!std::all_of(obstacle.rpy_rad.begin(), obstacle.rpy_rad.end(), is_small)) {
        errors.push_back({key + ".rpy_rad", "must be three angles of at most 1e5 rad; leave out whole turns"});
    }
}

void require_valid(const std::vector<Obstacle>& obstacles) {
    std::vector<KeyError> errors;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string key = "obstacles[" + std::to_string(i) + "]";
        std::visit(ShapeInspector{key, errors}, obstacles[i].shape);
        inspect_pose(obstacles[i], key, errors);
    }
    throw_if_any(std::move(errors));
}

/// Adds the parts of one obstacle and returns the bounds of them all.
struct PartsMaker {
    const Obstacle& obstacle;
    std::size_t number;
    const std::string& key;
    SceneSolids& solids;

    Vector3 to_world(const Matrix3& rotation, const Vector3& p_m) const {
        return obstacle.center_world_m + rotation * p_m;
    }
    void require_room(std::size_t more, const char* name) const {
        if (solids.parts.count() + more > max_pieces) {
            throw_input_error("raises the scene above " + std::to_string(max_pieces) +
                                  " triangles and boxes: leave out what the robot cannot reach",
                              key + name);
        }
    }
    BoundingBox operator()(const Primitive& primitive) const {
        solids.obstacle_of_primitive.push_back(number);
        solids.parts.add(primitive, obstacle.center_world_m, placement_of(primitive, rotation_of(obstacle.rpy_rad)));
        return solids.parts.primitive_bounds.back();
    }
    BoundingBox operator()(const Octomap& octomap) const {
        const std::vector<LocalBox> boxes = solid_boxes(octomap);
        require_room(boxes.size(), ".octomap.file");
        Parts& parts = solids.parts;
        const Placement placement = placement_of(Box{}, rotation_of(obstacle.rpy_rad));
        const auto turn = static_cast<std::uint32_t>(parts.octree_placements.size());
        parts.octree_placements.push_back(placement);
        solids.obstacle_of_octree.push_back(number);
        BoundingBox bounds = nothing;
        for (const LocalBox& box : boxes) {
            const OctreeBox placed{to_world(placement.rotation, box.center_m), box.size_m, turn};
            parts.octree_boxes.push_back(placed);
            bounds.include(bounds_of(convex_of(Box{placed.size_m}, placed.center_m, placement)));
        }
        return bounds;
    }
    BoundingBox operator()(const Mesh& mesh) const {
        require_room(mesh.surface->triangles.size(), ".mesh.file");
        const MeshSides sides = sides_of(*mesh.surface);
        if (sides.kind == SurfaceKind::contradictory) {
            throw_input_error(
                "has triangles that disagree about which side is outside: repair the mesh so that it "
                "encloses a space, or has a rim and is a sheet",
                key + ".mesh.file");
        }
        std::vector<Triangle>& triangles = solids.parts.triangles;
        const Matrix3 rotation = rotation_of(obstacle.rpy_rad);
        const std::size_t first = triangles.size();
        solids.meshes.push_back({first, number});
        BoundingBox bounds = nothing;
        const auto place_from = [&](std::size_t at) {
            for (; at < triangles.size(); ++at) {
                for (Vector3& corner : triangles[at]) {
                    corner = to_world(rotation, corner);
                }
                bounds.include(bounds_of(triangles[at]));
            }
        };
        triangles.reserve(first + mesh.surface->triangles.size());
        add_triangles(mesh, sides, false, triangles);
        place_from(first);
        const std::size_t first_of_sheets = triangles.size();
        if (first_of_sheets > first) {
            solids.closed_surfaces.push_back({first, first_of_sheets, bounds, number});
        }
        add_triangles(mesh, sides, true, triangles);
        place_from(first_of_sheets);
        solids.facts.back() = sides.facts;
        return bounds;
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr BoundingBox nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
};

std::shared_ptr<const SceneSolids> placed(std::vector<Obstacle> obstacles) {
    require_valid(obstacles);
    auto solids = std::make_shared<SceneSolids>();
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string key = "obstacles[" + std::to_string(i) + "]";
        solids->facts.push_back({1, 1, 0, {}});
        solids->bounds.push_back(std::visit(PartsMaker{obstacles[i], i, key, *solids}, obstacles[i].shape));
    }
    solids->parts.index();
    solids->obstacles = std::move(obstacles);
    return solids;
}

/// What counts as free of an octree although no sensor saw it, as an obstacle of its own; nothing if there is none.
std::optional<Obstacle> unseen_of(const Obstacle& obstacle) {
    const auto* octomap = std::get_if<Octomap>(&obstacle.shape);
    if (octomap == nullptr || octomap->unknown == UnknownSpace::occupied || !octomap->tree->has_free_leaf ||
        octomap->tree->unseen.empty()) {
        return std::nullopt;
    }
    OccupancyTree unseen{octomap->tree->resolution_m, {}, octomap->tree->unseen};
    Obstacle alone = obstacle;
    alone.shape = Octomap{"", std::make_shared<const OccupancyTree>(std::move(unseen)), UnknownSpace::occupied};
    return alone;
}

}  // namespace

void inspect(const Primitive& shape, const std::string& key, std::vector<KeyError>& errors) {
    std::visit(ShapeInspector{key, errors}, shape);
}

Scene::Scene(std::vector<Obstacle> obstacles) : solids_(placed(std::move(obstacles))) {}

const std::vector<Obstacle>& Scene::obstacles() const noexcept {
    return solids_->obstacles;
}

const BoundingBox& Scene::bounds(std::size_t obstacle) const noexcept {
    return solids_->bounds[obstacle];
}

const SurfaceFacts& Scene::facts(std::size_t obstacle) const noexcept {
    return solids_->facts[obstacle];
}

std::size_t Scene::obstacle_of(std::size_t part) const noexcept {
    return solids_->obstacle_of(part);
}

std::shared_ptr<const Scene> Scene::unseen_space() const {
    std::call_once(solids_->is_unseen_made, [this] {
        std::vector<Obstacle> all;
        for (const Obstacle& obstacle : obstacles()) {
            if (std::optional<Obstacle> unseen = unseen_of(obstacle)) {
                all.push_back(std::move(*unseen));
            }
        }
        if (!all.empty()) {
            solids_->unseen = std::make_shared<const Scene>(std::move(all));
        }
    });
    return solids_->unseen;
}

std::size_t Scene::part_count() const noexcept {
    return solids_->parts.count();
}

std::size_t Scene::primitive_count() const noexcept {
    return solids_->parts.primitives.size();
}

void Scene::add_parts_meeting(const BoundingBox& box, std::pmr::vector<std::size_t>& parts) const {
    const Parts& all = solids_->parts;
    const auto gap = [&](const BoundingBox& other) { return gap_m(box, other); };
    all.any(gap, 0, [&](std::size_t part) {
        if (gap(all.bounds(part)) <= 0) {
            parts.push_back(part);
        }
        return false;
    });
}

bool Scene::is_triangle(std::size_t part) const noexcept {
    return part >= solids_->parts.first_triangle();
}

BoundingBox Scene::part_bounds(std::size_t part) const noexcept {
    return solids_->parts.bounds(part);
}

const SceneSolids& Scene::solids() const noexcept {
    return *solids_;
}

}  // namespace downwash
