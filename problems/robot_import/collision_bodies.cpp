#include "downwash/robot_import/collision_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/robot_import/enclosing_solid.hpp"
#include "downwash/robot_import/mesh_solids.hpp"
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

std::vector<Vector3> corners_of(const Box& box, const RigidTransform& outer) {
    std::vector<Vector3> corners;
    for (int i = 0; i < 8; ++i) {
        const auto end = [&box, i](unsigned k) {
            return ((static_cast<unsigned>(i) >> k) & 1U ? 0.5 : -0.5) * box.size_m[k];
        };
        corners.push_back(outer.placed({end(0), end(1), end(2)}));
    }
    return corners;
}

/// The vertices of the pieces of a mesh, in axes that a transform leads to. Empty, with an error or a warning, if it
/// cannot be read.
std::vector<std::vector<Vector3>> mesh_pieces(const MeshReference& mesh, const TreeShape& shape, const TreeLink& link,
                                              const RigidTransform& outer, bool skips_meshes, Findings& findings) {
    const auto lacks = [&](const std::string& why) -> std::vector<std::vector<Vector3>> {
        const std::string text = "link '" + excerpt(link.name) + "': the mesh '" + excerpt(mesh.file) + "' " + why;
        if (skips_meshes) {
            findings.warn(shape.place, text + ": left out");
        } else {
            findings.error(shape.place, text + "; --skip-meshes leaves such shapes out");
        }
        return {};
    };
    if (!mesh.is_resolved) {
        return lacks("is not there: expected that file, or its package in a folder around this one");
    }
    try {
        if (mesh.pieces.empty()) {
            static_cast<void>(read_mesh(mesh.file));  // says why read_meshes() could not
        }
        std::vector<std::vector<Vector3>> pieces = mesh.pieces;
        std::vector<Vector3> corners;
        for (std::vector<Vector3>& piece : pieces) {
            for (Vector3& at : piece) {
                at = outer.placed({mesh.scale[0] * at[0], mesh.scale[1] * at[1], mesh.scale[2] * at[2]});
            }
            const BoundingBox box = bounds_around(piece);
            corners.insert(corners.end(), {box.low_m, box.high_m});
        }
        const BoundingBox bounds = corners.empty() ? BoundingBox{} : bounds_around(corners);
        constexpr double longest_m = 40;
        if (const double length_m = length_of(bounds.high_m - bounds.low_m); length_m > longest_m) {
            return lacks("is " + to_text(length_m, 4) +
                         " m long: expected metres; is it in mm? Then it needs scale=\"0.001 0.001 0.001\"");
        }
        return pieces;
    } catch (const InputError& error) {
        return lacks(std::string("cannot be read (") + error.what() + "): expected .stl or .obj");
    }
}

/// The least solid around points, with a warning of how much larger it is.
/// @param what they are the corners of: "a box that is askew"
SpaceBodyShape around(const std::vector<Vector3>& points_m, const std::string& what, const TreeShape& shape,
                      const TreeLink& link, const RigidTransform& outer, Findings& findings) {
    const Matrix3 axes = transposed(outer.rotation);
    const EnclosingSolid solid = least_solid_around(points_m, {axes[0], axes[1], axes[2]});
    findings.warn(shape.place, "link '" + excerpt(link.name) + "' has " + what + ": taken is the " +
                                   name_of(solid.body.shape) + " around it, which stands out from its convex hull by " +
                                   "up to " + to_text(solid.excess_m, 2) + " m");
    return solid.body;
}

/// One solid around each group of pieces of a mesh.
std::vector<SpaceBodyShape> around_pieces(std::vector<std::vector<Vector3>> pieces, const std::string& what,
                                          const TreeShape& shape, const TreeLink& link, const RigidTransform& outer,
                                          Findings& findings) {
    const std::size_t count = pieces.size();
    const std::vector<std::vector<Vector3>> groups = joined_pieces(std::move(pieces));
    if (groups.size() == 1) {
        return {around(groups[0], what, shape, link, outer, findings)};
    }
    const Matrix3 axes = transposed(outer.rotation);
    std::vector<SpaceBodyShape> solids;
    double excess_m = 0;
    for (const std::vector<Vector3>& group : groups) {
        const EnclosingSolid solid = least_solid_around(group, {axes[0], axes[1], axes[2]});
        excess_m = std::max(excess_m, solid.excess_m);
        solids.push_back(solid.body);
    }
    findings.warn(shape.place, "link '" + excerpt(link.name) + "' has " + what + " of " + std::to_string(count) +
                                   " separate pieces: taken are " + std::to_string(solids.size()) +
                                   " solids around them, which stand out from the pieces' convex hulls by up to " +
                                   to_text(excess_m, 2) + " m");
    return solids;
}

std::vector<SpaceBodyShape> solids_of(const TreeShape& shape, const TreeLink& link, const RigidTransform& pose,
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
            return {};
        }
        if (!is_straight(outer.rotation)) {
            return {around(corners_of(*box, outer), "a box that is askew", shape, link, outer, findings)};
        }
        return {{Box{2.0 * half_extents(outer.rotation, 0.5 * box->size_m)}, outer.position_m}};
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape.form)) {
        if (!require_size({cylinder->radius_m, cylinder->length_m})) {
            return {};
        }
        return {{Cylinder{cylinder->radius_m, cylinder->length_m, outer.rotation * cylinder->axis}, outer.position_m}};
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape.form)) {
        if (!require_size({sphere->radius_m})) {
            return {};
        }
        return {{*sphere, outer.position_m}};
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape.form)) {
        if (!require_size({capsule->radius_m})) {
            return {};
        }
        return {{Capsule{capsule->radius_m, outer.rotation * capsule->from_m, outer.rotation * capsule->to_m},
                 outer.position_m}};
    }
    const auto& mesh = std::get<MeshReference>(shape.form);
    std::vector<std::vector<Vector3>> pieces = mesh_pieces(mesh, shape, link, outer, skips_meshes, findings);
    if (pieces.empty()) {
        return {};
    }
    return around_pieces(std::move(pieces), "the mesh '" + excerpt(mesh.file) + "'", shape, link, outer, findings);
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
            const std::vector<SpaceBodyShape> solids = solids_of(shape, link, pose, skips_meshes, findings);
            bodies.insert(bodies.end(), solids.begin(), solids.end());
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
            std::vector<Vector3> vertices;
            for (const auto& piece : mesh_pieces(*mesh, shape, link, shape.pose, skips_meshes, findings)) {
                vertices.insert(vertices.end(), piece.begin(), piece.end());
            }
            if (!vertices.empty()) {
                const BoundingBox bounds = bounds_around(vertices);
                const Vector3 size_m = bounds.high_m - bounds.low_m;
                across_m = 0.5 * *std::ranges::max_element(size_m);
            }
        }
        radius_m = std::max(radius_m, across_m);
    }
    return radius_m;
}

}  // namespace downwash::robot_import
