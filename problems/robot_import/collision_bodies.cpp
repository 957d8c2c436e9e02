#include "downwash/robot_import/collision_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/mesh_file.hpp"

namespace downwash::robot_import {
namespace {

/// Sizes below are of no solid.
constexpr double least_m = 1e-6;

Vector3 half_extents(const Matrix3& rotation, const Vector3& half_m) {
    Vector3 outer{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            outer[i] += std::abs(rotation[i][k]) * half_m[k];
        }
    }
    return outer;
}

/// Whether a rotation maps axes on axes.
bool is_straight(const Matrix3& rotation) {
    constexpr double rounding = 1e-9;
    return std::ranges::all_of(rotation, [](const Vector3& row) {
        return std::ranges::any_of(row, [](double x) { return std::abs(std::abs(x) - 1) < rounding; });
    });
}

SpaceBodyShape box_around(const BoundingBox& bounds) {
    Vector3 size_m = bounds.high_m - bounds.low_m;
    for (double& edge_m : size_m) {
        edge_m = std::max(edge_m, 1e-3);  // a sheet
    }
    return {Box{size_m}, 0.5 * (bounds.low_m + bounds.high_m)};
}

/// The box of a mesh's file, in axes that a transform leads to. Empty, with an error or a warning, if it cannot be
/// read.
std::optional<BoundingBox> mesh_bounds(const MeshReference& mesh, const TreeShape& shape, const TreeLink& link,
                                       const RigidTransform& outer, bool skips_meshes, Findings& findings) {
    const auto lacks = [&](const std::string& why) -> std::optional<BoundingBox> {
        const std::string text = "link '" + excerpt(link.name) + "': the mesh '" + excerpt(mesh.file) + "' " + why;
        if (skips_meshes) {
            findings.warn(shape.place, text + ": left out");
        } else {
            findings.error(shape.place, text + "; --skip-meshes leaves such shapes out");
        }
        return std::nullopt;
    };
    if (!mesh.is_resolved) {
        return lacks("is not there: expected that file, or its package in a folder around this one");
    }
    try {
        const auto surface = read_mesh(mesh.file);
        std::optional<BoundingBox> bounds;
        for (const Vector3& vertex : surface->vertices_m) {
            const Vector3 at =
                outer.placed({mesh.scale[0] * vertex[0], mesh.scale[1] * vertex[1], mesh.scale[2] * vertex[2]});
            if (bounds) {
                bounds->include({at, at});
            } else {
                bounds = BoundingBox{at, at};
            }
        }
        if (bounds && length_of(bounds->high_m - bounds->low_m) > 40) {
            return lacks("is " + to_text(length_of(bounds->high_m - bounds->low_m), 4) +
                         " m long: expected metres; is it in mm? Then it needs scale=\"0.001 0.001 0.001\"");
        }
        return bounds;
    } catch (const InputError& error) {
        return lacks(std::string("cannot be read (") + error.what() + "): expected .stl or .obj");
    }
}

std::optional<SpaceBodyShape> solid_of(const TreeShape& shape, const TreeLink& link, const RigidTransform& pose,
                                       bool skips_meshes, Findings& findings) {
    const RigidTransform outer = pose * shape.pose;
    const std::string name = "link '" + excerpt(link.name) + "'";
    const auto require_size = [&](std::initializer_list<double> sizes_m) {
        const bool is_solid = std::ranges::all_of(sizes_m, [](double size_m) { return size_m >= least_m; });
        if (!is_solid) {
            findings.error(shape.place, name + " has a shape of no size: expected sizes above 0 [m]");
        }
        return is_solid;
    };
    if (const auto* box = std::get_if<Box>(&shape.form)) {
        if (!require_size({box->size_m[0], box->size_m[1], box->size_m[2]})) {
            return std::nullopt;
        }
        if (!is_straight(outer.rotation)) {
            findings.warn(shape.place, name + " has a box that is askew: taken is the box around it");
        }
        return SpaceBodyShape{Box{2.0 * half_extents(outer.rotation, 0.5 * box->size_m)}, outer.position_m};
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape.form)) {
        if (!require_size({cylinder->radius_m, cylinder->length_m})) {
            return std::nullopt;
        }
        return SpaceBodyShape{Cylinder{cylinder->radius_m, cylinder->length_m, outer.rotation * cylinder->axis},
                              outer.position_m};
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape.form)) {
        if (!require_size({sphere->radius_m})) {
            return std::nullopt;
        }
        return SpaceBodyShape{*sphere, outer.position_m};
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape.form)) {
        if (!require_size({capsule->radius_m})) {
            return std::nullopt;
        }
        return SpaceBodyShape{
            Capsule{capsule->radius_m, outer.rotation * capsule->from_m, outer.rotation * capsule->to_m},
            outer.position_m};
    }
    const auto& mesh = std::get<MeshReference>(shape.form);
    const auto bounds = mesh_bounds(mesh, shape, link, outer, skips_meshes, findings);
    if (!bounds) {
        return std::nullopt;
    }
    findings.warn(shape.place, name + ": taken of the mesh '" + excerpt(mesh.file) + "' is the box around it");
    return box_around(*bounds);
}

const std::vector<TreeShape>& shapes_of(const TreeLink& link) {
    return link.collision.empty() ? link.visual : link.collision;
}

}  // namespace

std::vector<SpaceBodyShape> collision_bodies(const KinematicTree& tree, const ArmChain& chain, int part,
                                             const Vector3& origin_m, const std::vector<int>& skipped,
                                             bool skips_meshes, Findings& findings) {
    std::vector<SpaceBodyShape> bodies;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        if (chain.part[i] != part || std::ranges::find(skipped, static_cast<int>(i)) != skipped.end()) {
            continue;
        }
        const TreeLink& link = tree.links[i];
        if (link.collision.empty() && !link.visual.empty()) {
            findings.warn(link.place,
                          "link '" + excerpt(link.name) + "' has no collision geometry: taken are its visual shapes");
        }
        const RigidTransform pose{chain.pose[i].rotation, chain.pose[i].position_m - origin_m};
        for (const TreeShape& shape : shapes_of(link)) {
            if (auto solid = solid_of(shape, link, pose, skips_meshes, findings)) {
                bodies.push_back(*solid);
            }
        }
    }
    return bodies;
}

double disc_radius_m(const TreeLink& link, bool skips_meshes, Findings& findings) {
    double radius_m = 0;
    for (const TreeShape& shape : shapes_of(link)) {
        double across_m = 0;
        if (const auto* cylinder = std::get_if<Cylinder>(&shape.form)) {
            across_m = std::max(cylinder->radius_m, 0.5 * cylinder->length_m);
        } else if (const auto* box = std::get_if<Box>(&shape.form)) {
            across_m = 0.5 * *std::ranges::max_element(box->size_m);
        } else if (const auto* sphere = std::get_if<Sphere>(&shape.form)) {
            across_m = sphere->radius_m;
        } else if (const auto* mesh = std::get_if<MeshReference>(&shape.form)) {
            if (const auto bounds = mesh_bounds(*mesh, shape, link, shape.pose, skips_meshes, findings)) {
                const Vector3 size_m = bounds->high_m - bounds->low_m;
                across_m = 0.5 * *std::ranges::max_element(size_m);
            }
        }
        radius_m = std::max(radius_m, across_m);
    }
    return radius_m;
}

}  // namespace downwash::robot_import
