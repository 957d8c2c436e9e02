#include "downwash/robot_import/robot_builder.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/robot_import/collision_bodies.hpp"
#include "downwash/robot_import/mesh_solids.hpp"

namespace downwash::robot_import {
namespace {

/// A name as robot files have it.
std::string identifier_of(const std::string& name) {
    constexpr std::size_t longest = 64;
    std::string sound = name.substr(0, longest);
    std::ranges::replace_if(
        sound, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-'; }, '_');
    return sound.empty() ? "robot" : sound;
}

class Builder {
 public:
    Builder(const KinematicTree& tree, const ArmChain& chain, const ImportSettings& settings, Findings& findings)
        : tree_(tree), chain_(chain), settings_(settings), findings_(findings) {}

    BuiltRobot built() {
        check_links(tree_, chain_, settings_, findings_);
        made_.rotors = imported_rotors(tree_, chain_, settings_, findings_);
        findings_.throw_if_any();
        parts_ = part_masses(massive(), chain_, findings_);
        SpaceRobot& robot = made_.robot;
        robot.name = identifier_of(settings_.name.empty() ? tree_.name : settings_.name);
        robot.plant.multirotor = {parts_[0].mass_kg, parts_[0].inertia_kg_m2};
        made_.frozen = chain_.frozen;
        for (const PartMass& part : parts_) {
            made_.part_sources.push_back(joined(part.links, ", ", [this](int link) {
                const TreeLink& one = tree_.links[static_cast<std::size_t>(link)];
                return excerpt(one.name) + " " + to_text(one.inertial->mass_kg, 6) + " kg";
            }));
        }
        add_rotors();
        add_links();
        add_bodies();
        add_tool();
        warn_of_hub();
        findings_.throw_if_any();
        return made_;
    }

 private:
    /// The tree without the masses of links that are to have none.
    [[nodiscard]] KinematicTree massive() const {
        KinematicTree tree = tree_;
        for (TreeLink& link : tree.links) {
            if (std::ranges::find(settings_.massless, link.name) != settings_.massless.end()) {
                link.inertial.reset();
            }
        }
        return tree;
    }

    /// Where the frame of a part begins, from the base's origin.
    [[nodiscard]] Vector3 origin_m(std::size_t part) const {
        return part == 0 ? parts_[0].center_of_mass_m : anchor_m(part - 1);
    }
    [[nodiscard]] const TreeJoint& joint(std::size_t i) const {
        return tree_.joints[static_cast<std::size_t>(chain_.joints[i])];
    }
    [[nodiscard]] const RigidTransform& child_pose(std::size_t i) const {
        return chain_.pose[static_cast<std::size_t>(joint(i).child)];
    }
    [[nodiscard]] Vector3 anchor_m(std::size_t i) const { return child_pose(i).placed(joint(i).anchor_m); }

    void add_rotors() {
        SpaceRobot& robot = made_.robot;
        ImportedRotors& rotors = made_.rotors;
        for (SpaceRotor& rotor : rotors.rotors) {
            rotor.position_m = rotor.position_m - origin_m(0);
        }
        robot.plant.rotors = rotors.rotors;
        robot.rotor_radius_m = rotors.radius_m.value;
        robot.min_thrust_n = rotors.min_thrust_n;
        robot.max_thrust_n = rotors.max_thrust_n;
        robot.plant.time_constant_s = rotors.time_constant_s.value;
        robot.plant.power_coefficient_w_n1p5 = rotors.power_coefficient_w_n1p5.value;
        robot.plant.thrust_coefficient_n_s2 = rotors.thrust_coefficient_n_s2.value;
    }

    void add_links() {
        for (std::size_t i = 0; i < chain_.joints.size(); ++i) {
            const TreeJoint& from = joint(i);
            const PartMass& part = parts_[i + 1];
            SpaceLink link;
            link.body = {part.mass_kg, part.inertia_kg_m2};
            link.joint_m = anchor_m(i) - origin_m(i);
            link.axis = unit(child_pose(i).rotation * from.axis);
            link.center_of_mass_m = part.center_of_mass_m - anchor_m(i);
            link.viscous_friction_nm_s = std::max(from.damping_nm_s, 0.0);
            link.coulomb_friction_nm = std::max(from.friction_nm, 0.0);
            SpaceLinkLimits limits;
            limits.is_limited = true;
            limits.lower_limit_rad = *from.lower;
            limits.upper_limit_rad = *from.upper;
            limits.max_torque_nm = *from.effort_nm;
            made_.robot.plant.links.push_back(link);
            made_.robot.links.push_back(std::move(limits));
            made_.joint_names.push_back(from.name);
            made_.joint_rates.push_back(from.velocity_rad_s && *from.velocity_rad_s > 0
                                            ? to_text(*from.velocity_rad_s * degrees_per_radian, 4) + " deg/s"
                                            : std::string());
        }
    }

    void add_bodies() {
        std::vector<SpaceBodyShape> discs = disc_bodies();
        std::vector<SpaceBodyShape> bodies =
            collision_bodies(tree_, chain_, 0, origin_m(0), made_.rotors.links, settings_.skips_meshes, findings_);
        made_.body_source = bodies.empty() ? "around all rotor discs; the file has no shapes"
                                           : "the file's shapes, and around all rotor discs";
        if (bodies.empty()) {
            findings_.warn(tree_.links[static_cast<std::size_t>(chain_.base)].place,
                           "nothing of the multirotor has a shape but its rotors' discs: add bodies to the robot file");
        }
        bodies.insert(bodies.end(), discs.begin(), discs.end());
        made_.robot.body = std::move(bodies);
        for (std::size_t i = 0; i < chain_.joints.size(); ++i) {
            made_.robot.links[i].body = collision_bodies(tree_, chain_, static_cast<int>(i) + 1, origin_m(i + 1), {},
                                                         settings_.skips_meshes, findings_);
            if (made_.robot.links[i].body.empty()) {
                findings_.warn(joint(i).place, "what turns with joint '" + excerpt(joint(i).name) +
                                                   "' has no shape and touches nothing: add bodies to the robot file");
            }
        }
    }

    /// One cylinder around discs that are level, else one for each.
    [[nodiscard]] std::vector<SpaceBodyShape> disc_bodies() const {
        const SpaceRobot& robot = made_.robot;
        constexpr double thickness_m = 0.03, most_apart_m = 0.1, least_up = 0.95;
        double low_m = 1e9, high_m = -1e9, radius_m = 0;
        bool are_level = true;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            low_m = std::min(low_m, rotor.position_m[2]);
            high_m = std::max(high_m, rotor.position_m[2]);
            radius_m = std::max(radius_m, std::hypot(rotor.position_m[0], rotor.position_m[1]));
            are_level = are_level && rotor.axis[2] > least_up;
        }
        if (are_level && high_m - low_m < most_apart_m) {
            return {{Cylinder{radius_m + robot.rotor_radius_m, high_m - low_m + thickness_m, {0, 0, 1}},
                     {0, 0, 0.5 * (low_m + high_m)}}};
        }
        std::vector<SpaceBodyShape> discs;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            discs.push_back({Cylinder{robot.rotor_radius_m, thickness_m, rotor.axis}, rotor.position_m});
        }
        return discs;
    }

    void add_tool() {
        if (chain_.joints.empty()) {
            return;
        }
        const auto last = static_cast<int>(chain_.joints.size());
        const Vector3 from_m = origin_m(static_cast<std::size_t>(last));
        const int link = tool_link(last);
        Vector3 tool_m{};
        if (link >= 0) {
            tool_m = chain_.pose[static_cast<std::size_t>(link)].position_m - from_m;
            made_.tool_source = "the origin of " + excerpt(tree_.links[static_cast<std::size_t>(link)].name);
        } else {
            tool_m = farthest_of_bodies();
            made_.tool_source = "assumed: the farthest end of the last link's shapes; --tool LINK names another";
        }
        made_.robot.plant.end_effector_m = tool_m;
        if (has_direction(tool_m)) {
            made_.robot.tool_direction = unit(tool_m);
        }
    }

    /// The link that the settings name or, without one, the only link without mass that turns with the last joint.
    int tool_link(int last) {
        if (!settings_.tool.empty()) {
            const int link = tree_.link(settings_.tool);
            if (link < 0 || chain_.part[static_cast<std::size_t>(link)] != last) {
                findings_.error({}, "--tool " + excerpt(settings_.tool) +
                                        (link < 0 ? ": there is no such link"
                                                  : ": this link does not turn with the last joint, '" +
                                                        excerpt(made_.joint_names.back()) + "'") +
                                        ": expected a link at the end of the arm");
            }
            return link;
        }
        int found = -1;
        for (std::size_t i = 0; i < tree_.links.size(); ++i) {
            if (chain_.part[i] == last && !tree_.links[i].inertial && tree_.links[i].collision.empty()) {
                if (found >= 0) {
                    return -1;
                }
                found = static_cast<int>(i);
            }
        }
        return found;
    }

    /// The middle of the face of the last link's bounding box that is farthest from its joint.
    [[nodiscard]] Vector3 farthest_of_bodies() const {
        Vector3 farthest = made_.robot.plant.links.back().center_of_mass_m;
        for (const SpaceBodyShape& body : made_.robot.links.back().body) {
            Vector3 end = body.center_m;
            if (const auto* box = std::get_if<Box>(&body.shape)) {
                const auto longest =
                    static_cast<std::size_t>(std::ranges::max_element(box->size_m) - box->size_m.begin());
                end[longest] += std::copysign(0.5 * box->size_m[longest], end[longest]);
            } else if (const auto* cylinder = std::get_if<Cylinder>(&body.shape)) {
                const Vector3 way = (0.5 * cylinder->length_m) * unit(cylinder->axis);
                end = dot(end, way) < 0 ? end - way : end + way;
            } else if (const auto* capsule = std::get_if<Capsule>(&body.shape)) {
                const Vector3 one = body.center_m + capsule->from_m, other = body.center_m + capsule->to_m;
                end = length_of(one) > length_of(other) ? one : other;
            }
            if (length_of(end) > length_of(farthest)) {
                farthest = end;
            }
        }
        return farthest;
    }

    /// An inertia that is too small for where the rotors are.
    void warn_of_hub() {
        double span_m = 0;
        for (const SpaceRotor& rotor : made_.robot.plant.rotors) {
            span_m = std::max(span_m, std::hypot(rotor.position_m[0], rotor.position_m[1]));
        }
        const SpaceBody& body = made_.robot.plant.multirotor;
        const double gyration_m = std::sqrt(body.inertia_kg_m2[2][2] / body.mass_kg);
        if (gyration_m < 0.2 * span_m) {
            findings_.warn(parts_[0].place,
                           "the multirotor's inertia about z is that of its mass at " + to_text(gyration_m, 3) +
                               " m from its centre, and its rotors stand at " + to_text(span_m, 3) +
                               " m: is it that of the hub alone? Expected that of the whole vehicle, motors included");
        }
    }

    const KinematicTree& tree_;
    const ArmChain& chain_;
    const ImportSettings& settings_;
    Findings& findings_;
    std::vector<PartMass> parts_;
    BuiltRobot made_;
};

}  // namespace

BuiltRobot built_robot(KinematicTree tree, int root, const ImportSettings& settings, Findings& findings) {
    name_rotors(tree, settings, findings);
    read_meshes(tree);
    const ArmChain chain = arm_chain(tree, root, settings, findings);
    return Builder(tree, chain, settings, findings).built();
}

}  // namespace downwash::robot_import
