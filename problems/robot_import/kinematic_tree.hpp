#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/robot_import/findings.hpp"
#include "downwash/robot_import/rigid_transform.hpp"
#include "downwash/scene/space_shape.hpp"

// A robot as URDF, SDF and MJCF describe it: links that joints connect. What a format says in its own way is the same
// here: angles in rad, all else in SI units. Indices are those of KinematicTree's lists.

namespace downwash::robot_import {

/// A shape in a file of its own.
struct MeshReference {
    std::string file;         ///< a path that can be opened; as it stands in the file if it cannot be resolved
    Vector3 scale{1, 1, 1};   ///< of the vertices; a negative one mirrors
    bool is_resolved = true;  ///< whether a package or model that it names was found
    /// The vertices of its separate pieces in the file's unit, once it was read; empty: it was not, or cannot be.
    std::vector<std::vector<Vector3>> pieces;
};

/// A shape of a link.
struct TreeShape {
    std::variant<Box, Cylinder, Sphere, Capsule, MeshReference> form;
    RigidTransform pose;  ///< from the shape's axes to the link's
    Place place;
};

struct TreeInertial {
    double mass_kg = 0;
    Vector3 center_of_mass_m{};  ///< in the link's frame
    Matrix3 inertia_kg_m2{};     ///< about the centre of mass, in the link's axes
    Place place;
};

struct TreeLink {
    std::string name;
    Place place;
    std::optional<TreeInertial> inertial;  ///< empty: a frame without mass
    std::vector<TreeShape> collision, visual;
};

enum class JointKind { fixed, revolute, continuous, prismatic, floating, planar, ball, other };

/// Moves with another joint: angle = multiplier * that of `joint` + offset.
struct TreeMimic {
    std::string joint;
    double multiplier = 1, offset = 0;
};

struct TreeJoint {
    std::string name;
    Place place;
    JointKind kind = JointKind::fixed;
    std::string kind_name;                 ///< as the format calls it: "continuous"
    int parent = 0, child = 0;             ///< links
    RigidTransform origin;                 ///< from the child's frame to the parent's, at zero
    Vector3 anchor_m{};                    ///< a point on the axis, in the child's frame
    Vector3 axis{0, 0, 1};                 ///< in the child's frame, of any length
    std::optional<double> lower, upper;    ///< [rad], of prismatic joints [m]
    std::optional<double> effort_nm;       ///< greatest torque
    std::optional<double> velocity_rad_s;  ///< greatest rate
    double damping_nm_s = 0, friction_nm = 0;
    std::optional<TreeMimic> mimic;
};

/// A rotor that something in the file describes. Empty numbers are not in the file.
struct TreeRotor {
    std::string name;
    Place place;
    int link = 0;             ///< that it is part of
    Vector3 position_m{};     ///< its hub, in that link's frame
    Vector3 axis{0, 0, 1};    ///< direction of its thrust, in that link's axes
    std::optional<int> spin;  ///< 1 counterclockwise about its axis, -1 clockwise
    std::optional<double> radius_m, min_thrust_n, max_thrust_n, torque_ratio_m, time_constant_s,
        thrust_coefficient_n_s2;
    std::string source;         ///< what describes it, for comments
    std::string thrust_source;  ///< what its greatest thrust is computed from; empty: it is given as such
    std::optional<int> number;  ///< by which the autopilot counts it
};

struct KinematicTree {
    std::string name;
    std::string format;  ///< "URDF"
    std::vector<TreeLink> links;
    std::vector<TreeJoint> joints;
    std::vector<TreeRotor> rotors;

    /// The link or joint of a name; -1 if there is none.
    [[nodiscard]] int link(std::string_view wanted) const { return index_of(links, wanted); }
    [[nodiscard]] int joint(std::string_view wanted) const { return index_of(joints, wanted); }
    /// The joint by which a link hangs on another; -1: none.
    [[nodiscard]] int joint_of_child(int child) const {
        for (std::size_t j = 0; j < joints.size(); ++j) {
            if (joints[j].child == child) {
                return static_cast<int>(j);
            }
        }
        return -1;
    }

 private:
    template <class Parts>
    static int index_of(const Parts& parts, std::string_view wanted) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (parts[i].name == wanted) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }
};

}  // namespace downwash::robot_import
