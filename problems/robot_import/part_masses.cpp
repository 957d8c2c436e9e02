#include "downwash/robot_import/part_masses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "downwash/base/text.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash::robot_import {
namespace {

std::string named(const TreeLink& link) {
    return "link '" + excerpt(link.name) + "'";
}

std::string rounded(double value) {
    return to_text(value, 4);
}

std::string moments_text(const Vector3& moments) {
    return rounded(moments[0]) + ", " + rounded(moments[1]) + " and " + rounded(moments[2]) + " kg m2";
}

/// The inertia of a point mass about another place.
Matrix3 of_point(double mass_kg, const Vector3& r) {
    const double square = dot(r, r);
    Matrix3 inertia;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            inertia[i][k] = mass_kg * ((i == k ? square : 0) - r[i] * r[k]);
        }
    }
    return inertia;
}

/// No part of a vehicle that this planner is for is longer.
constexpr double longest_m = 20;
constexpr const char* in_metres =
    ": expected metres; is this in mm? Multiply lengths by 0.001 (scale=\"0.001 0.001 0.001\" "
    "of a mesh) and inertias in kg mm2 by 1e-6";

void check_lengths(const TreeLink& link, Findings& findings) {
    for (const auto* shapes : {&link.collision, &link.visual}) {
        for (const TreeShape& shape : *shapes) {
            // A mesh in other units is told by its own message.
            const double extent_m = std::holds_alternative<MeshReference>(shape.form) ? length_of(shape.pose.position_m)
                                                                                      : farthest_m(shape, {});
            if (extent_m > longest_m) {
                findings.error(shape.place, named(link) + " has a shape that extends to " + rounded(extent_m) +
                                                " m from its origin" + in_metres);
                return;
            }
        }
    }
    if (link.inertial && length_of(link.inertial->center_of_mass_m) > longest_m) {
        findings.error(link.inertial->place, named(link) + " has its centre of mass " +
                                                 rounded(length_of(link.inertial->center_of_mass_m)) +
                                                 " m from its origin" + in_metres);
    }
}

/// An inertia against the mass and the shapes that it is of.
void check_inertia(const TreeLink& link, Findings& findings) {
    const TreeInertial& inertial = *link.inertial;
    const Vector3 moments = principal_moments(inertial.inertia_kg_m2);
    constexpr double rounding = 1e-6;  // published inertias have few digits
    if (!is_finite(moments) || moments[0] < -rounding * std::abs(moments[2])) {
        findings.error(inertial.place, named(link) + " has the principal moments " + moments_text(moments) +
                                           ": expected none below 0; the products of inertia are too large");
        return;
    }
    if (moments[2] == 0) {
        findings.warn(inertial.place, named(link) + " has no inertia and counts as a point");
        return;
    }
    if (moments[2] > (moments[0] + moments[1]) * (1 + rounding)) {
        findings.error(inertial.place, named(link) + " has the principal moments " + moments_text(moments) +
                                           ", which no body has: expected the largest to be at most the sum of the "
                                           "others, " +
                                           rounded(moments[0] + moments[1]) +
                                           "; compute them from its shape or take them from CAD again");
        return;
    }
    double extent_m = 0;
    for (const TreeShape& shape : link.collision.empty() ? link.visual : link.collision) {
        extent_m = std::max(extent_m, farthest_m(shape, inertial.center_of_mass_m));
    }
    const double gyration_m = std::sqrt(moments[2] / inertial.mass_kg);
    if (gyration_m > longest_m / 4) {
        findings.error(inertial.place, named(link) + " has the inertia of its mass at " + rounded(gyration_m) +
                                           " m from its centre" + in_metres);
    } else if (extent_m > 0 && gyration_m > extent_m) {
        findings.warn(inertial.place, named(link) +
                                          " has more inertia than its whole mass at the farthest point of "
                                          "its shapes would have: sqrt(I / m) is " +
                                          rounded(gyration_m) + " m, they extend to " + rounded(extent_m) + " m");
    }
}

void check_link(const TreeLink& link, const ImportSettings& settings, Findings& findings) {
    check_lengths(link, findings);
    const bool is_massless = std::ranges::find(settings.massless, link.name) != settings.massless.end();
    if (!link.inertial) {
        if (!is_massless && !(link.collision.empty() && link.visual.empty())) {
            findings.error(link.place, named(link) +
                                           " has shapes and no inertial: expected its mass, centre of mass "
                                           "and inertia, or --massless " +
                                           link.name);
        }
        return;
    }
    if (is_massless) {
        return;
    }
    if (!(link.inertial->mass_kg > 0) || !std::isfinite(link.inertial->mass_kg)) {
        findings.error(link.inertial->place, named(link) + " has a mass of " + to_text(link.inertial->mass_kg) +
                                                 " kg: expected one above 0; a frame without mass has no inertial, or "
                                                 "--massless " +
                                                 link.name);
        return;
    }
    check_inertia(link, findings);
}

}  // namespace

double farthest_m(const TreeShape& shape, const Vector3& from_m) {
    const double away_m = length_of(shape.pose.position_m - from_m);
    const auto corner = [&](const Vector3& half_m) {
        double farthest = 0;
        for (int i = 0; i < 8; ++i) {
            const Vector3 at{i & 1 ? half_m[0] : -half_m[0], i & 2 ? half_m[1] : -half_m[1],
                             i & 4 ? half_m[2] : -half_m[2]};
            farthest = std::max(farthest, length_of(shape.pose.placed(at) - from_m));
        }
        return farthest;
    };
    if (const auto* box = std::get_if<Box>(&shape.form)) {
        return corner(0.5 * box->size_m);
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape.form)) {
        return corner({cylinder->radius_m, cylinder->radius_m, 0.5 * cylinder->length_m});
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape.form)) {
        return away_m + sphere->radius_m;
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape.form)) {
        return std::max(length_of(shape.pose.placed(capsule->from_m) - from_m),
                        length_of(shape.pose.placed(capsule->to_m) - from_m)) +
               capsule->radius_m;
    }
    double farthest = 0;
    const auto& mesh = std::get<MeshReference>(shape.form);
    for (const std::vector<Vector3>& piece : mesh.pieces) {
        for (const Vector3& at : piece) {
            const Vector3 scaled{mesh.scale[0] * at[0], mesh.scale[1] * at[1], mesh.scale[2] * at[2]};
            farthest = std::max(farthest, length_of(shape.pose.placed(scaled) - from_m));
        }
    }
    return farthest;
}

void check_links(const KinematicTree& tree, const ArmChain& chain, const ImportSettings& settings, Findings& findings) {
    for (const std::string& name : settings.massless) {
        if (tree.link(name) < 0) {
            findings.error({}, "--massless " + excerpt(name) + ": there is no such link");
        }
    }
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        if (chain.part[i] >= 0) {
            check_link(tree.links[i], settings, findings);
        }
    }
    for (const TreeJoint& joint : tree.joints) {
        const double away_m = length_of(joint.origin.position_m);
        if (away_m > longest_m && joint.kind != JointKind::floating) {
            findings.error(joint.place, "joint '" + excerpt(joint.name) + "' stands " + rounded(away_m) +
                                            " m from the link before" + in_metres);
        }
    }
}

std::vector<PartMass> part_masses(const KinematicTree& tree, const ArmChain& chain, Findings& findings) {
    std::vector<PartMass> parts(chain.joints.size() + 1);
    std::vector<double> heaviest_kg(parts.size(), 0);
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        const std::optional<TreeInertial>& inertial = tree.links[i].inertial;
        if (chain.part[i] < 0 || !inertial || !(inertial->mass_kg > 0)) {
            continue;
        }
        const auto k = static_cast<std::size_t>(chain.part[i]);
        PartMass& part = parts[k];
        part.links.push_back(static_cast<int>(i));
        part.mass_kg += inertial->mass_kg;
        part.center_of_mass_m =
            part.center_of_mass_m + inertial->mass_kg * chain.pose[i].placed(inertial->center_of_mass_m);
        if (inertial->mass_kg > heaviest_kg[k]) {
            heaviest_kg[k] = inertial->mass_kg;
            part.place = inertial->place;
        }
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
        PartMass& part = parts[k];
        if (part.links.empty()) {
            if (k == 0) {
                findings.error(tree.links[static_cast<std::size_t>(chain.base)].place,
                               "nothing of the multirotor has a mass: expected inertial of link '" +
                                   excerpt(tree.links[static_cast<std::size_t>(chain.base)].name) + "'");
            } else {
                const TreeJoint& joint = tree.joints[static_cast<std::size_t>(chain.joints[k - 1])];
                findings.error(joint.place, "nothing that turns with joint '" + excerpt(joint.name) +
                                                "' has a mass: expected inertial of link '" +
                                                excerpt(tree.links[static_cast<std::size_t>(joint.child)].name) +
                                                "', or --freeze " + joint.name + "=DEG");
            }
            continue;
        }
        part.center_of_mass_m = (1 / part.mass_kg) * part.center_of_mass_m;
        for (const int i : part.links) {
            const auto& inertial = *tree.links[static_cast<std::size_t>(i)].inertial;
            const RigidTransform& pose = chain.pose[static_cast<std::size_t>(i)];
            part.inertia_kg_m2 =
                part.inertia_kg_m2 + pose.rotation * inertial.inertia_kg_m2 * transposed(pose.rotation) +
                of_point(inertial.mass_kg, pose.placed(inertial.center_of_mass_m) - part.center_of_mass_m);
        }
    }
    findings.throw_if_any();
    return parts;
}

}  // namespace downwash::robot_import
