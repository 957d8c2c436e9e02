#include "downwash/robot_import/arm_chain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_reference.hpp"

namespace downwash::robot_import {
namespace {

std::string quoted(const std::string& name) {
    return "'" + excerpt(name) + "'";
}

const char* unit_of(const TreeJoint& joint) {
    return joint.kind == JointKind::prismatic ? "M" : "DEG";
}

std::string freeze_option(const TreeJoint& joint) {
    return "--freeze " + joint.name + "=" + unit_of(joint);
}

/// Finds the chain, with all errors on the way.
class Search {
 public:
    Search(const KinematicTree& tree, const ImportSettings& settings, Findings& findings)
        : tree_(tree), settings_(settings), findings_(findings), below_(tree.links.size()) {
        for (std::size_t j = 0; j < tree.joints.size(); ++j) {
            below_[static_cast<std::size_t>(tree.joints[j].parent)].push_back(static_cast<int>(j));
        }
    }

    ArmChain found(int root) {
        chain_.base = base_below(root);
        chain_.part.assign(tree_.links.size(), -1);
        chain_.pose.assign(tree_.links.size(), {});
        take_frozen();
        take_arm_end();
        findings_.throw_if_any();
        walk(chain_.base, 0, {axes_turn(), {}});
        findings_.throw_if_any();
        require_few();
        return chain_;
    }

 private:
    [[nodiscard]] const TreeJoint& joint(int j) const { return tree_.joints[static_cast<std::size_t>(j)]; }
    [[nodiscard]] const TreeLink& link(int l) const { return tree_.links[static_cast<std::size_t>(l)]; }

    /// From the base's axes to ours.
    Matrix3 axes_turn() {
        const auto axis = [this](const std::string& name, const char* option) {
            const std::size_t sign = name.starts_with("-") || name.starts_with("+") ? 1 : 0;
            const std::size_t which = std::string("xyz").find(name.substr(sign));
            Vector3 direction{};
            if (name.size() != sign + 1 || which == std::string::npos) {
                findings_.fail({}, std::string(option) + " " + excerpt(name) + ": expected an axis such as x or -y");
            }
            direction[which] = name[0] == '-' ? -1 : 1;
            return direction;
        };
        const Vector3 forward = axis(settings_.forward, "--forward"), up = axis(settings_.up, "--up");
        if (dot(forward, up) != 0) {
            findings_.fail(
                {}, "--forward " + settings_.forward + " and --up " + settings_.up + " are one axis: expected two");
        }
        return {forward, cross(up, forward), up};
    }

    /// A vehicle that hangs on a world by a floating joint begins below it.
    [[nodiscard]] int base_below(int root) const {
        const auto& joints = below_[static_cast<std::size_t>(root)];
        const bool floats = joints.size() == 1 && joint(joints[0]).kind == JointKind::floating;
        return floats && !link(root).inertial ? joint(joints[0]).child : root;
    }

    void take_frozen() {
        for (const FrozenJoint& given : settings_.frozen) {
            const int j = tree_.joint(given.joint);
            if (j < 0) {
                findings_.error({}, "--freeze " + excerpt(given.joint) + ": there is no such joint: expected one of " +
                                        joint_names());
            } else {
                freeze(j, joint(j).kind == JointKind::prismatic ? given.position : given.position / degrees_per_radian);
            }
        }
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            freeze_without_way(static_cast<int>(j));
            freeze_with_leader(static_cast<int>(j));
        }
    }

    /// Models of classic Gazebo fix parts by joints with a single place.
    void freeze_without_way(int j) {
        const TreeJoint& one = joint(j);
        if (one.lower && one.upper && *one.lower == *one.upper && !frozen_.contains(j)) {
            frozen_[j] = *one.lower;
        }
    }

    void freeze(int j, double position) {
        const TreeJoint& one = joint(j);
        constexpr double rounding = 1e-9;
        if ((one.lower && position < *one.lower - rounding) || (one.upper && position > *one.upper + rounding)) {
            findings_.error(one.place, "joint " + quoted(one.name) + " is frozen beyond its limits, " +
                                           text_of(one, *one.lower) + " to " + text_of(one, *one.upper) +
                                           ": expected " + freeze_option(one) + " within them");
        }
        frozen_[j] = position;
    }

    /// A joint that mimics a frozen one stands still, too.
    void freeze_with_leader(int j) {
        std::set<int> seen{j};
        double multiplier = 1, offset = 0;
        for (int at = j; joint(at).mimic;) {
            const TreeMimic& mimic = *joint(at).mimic;
            offset += multiplier * mimic.offset;
            multiplier *= mimic.multiplier;
            at = tree_.joint(mimic.joint);
            if (at < 0 || !seen.insert(at).second) {
                return;  // walk() reports it
            }
            if (const auto leader = frozen_.find(at); leader != frozen_.end() && !frozen_.contains(j)) {
                frozen_[j] = multiplier * leader->second + offset;
                return;
            }
        }
    }

    /// All joints that do not lead to the end of the arm are frozen at zero.
    void take_arm_end() {
        if (settings_.arm_end.empty()) {
            return;
        }
        int at = tree_.link(settings_.arm_end);
        if (at < 0) {
            findings_.error({}, "--arm " + excerpt(settings_.arm_end) +
                                    ": there is no such link: expected the last link of the arm");
            return;
        }
        std::set<int> kept;
        for (int j = tree_.joint_of_child(at); j >= 0; j = tree_.joint_of_child(joint(j).parent)) {
            kept.insert(j);
        }
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            const int one = static_cast<int>(j);
            if (joint(one).kind != JointKind::fixed && !kept.contains(one) && !frozen_.contains(one)) {
                frozen_[one] = 0;
            }
        }
    }

    void walk(int at, int part, const RigidTransform& pose) {
        chain_.part[static_cast<std::size_t>(at)] = part;
        chain_.pose[static_cast<std::size_t>(at)] = pose;
        for (const int j : below_[static_cast<std::size_t>(at)]) {
            const TreeJoint& one = joint(j);
            double position = 0;
            int next = part;
            if (const auto frozen = frozen_.find(j); frozen != frozen_.end()) {
                position = frozen->second;
                chain_.frozen.push_back(one.name + " at " + text_of(one, position));
            } else if (one.kind != JointKind::fixed && !is_of_rotor(one)) {
                next = take_moving(j, part);
            }
            walk(one.child, next, pose * one.origin * motion(one, position));
        }
    }

    /// @return the part that turns with it
    int take_moving(int j, int part) {
        require_revolute(joint(j));
        if (part == static_cast<int>(chain_.joints.size())) {
            chain_.joints.push_back(j);
            return part + 1;
        }
        const TreeJoint& other = joint(chain_.joints[static_cast<std::size_t>(part)]);
        findings_.error(joint(j).place, "joint " + quoted(joint(j).name) +
                                            " begins a second arm beside that of joint " + quoted(other.name) +
                                            ": expected one serial chain; choose one by --arm LINK, the link at "
                                            "its end, or hold joints by " +
                                            freeze_option(joint(j)));
        return part;  // all below stands still for this reading
    }

    void require_revolute(const TreeJoint& one) {
        const std::string name = "joint " + quoted(one.name);
        if (one.mimic) {
            findings_.error(one.place, name + " mimics " + quoted(one.mimic->joint) +
                                           ", which Downwash does not do: hold it by " + freeze_option(one) +
                                           ", or freeze the joint that it follows");
        } else if (one.kind == JointKind::continuous) {
            findings_.error(one.place, name + " turns without end (" + one.kind_name +
                                           "): expected limits, type=\"revolute\" with <limit>, or " +
                                           freeze_option(one) + "; if it carries a rotor, name it by --rotors REGEX");
        } else if (one.kind != JointKind::revolute) {
            findings_.error(one.place, name + " is " + one.kind_name +
                                           ": an arm has revolute joints alone; hold it by " + freeze_option(one));
        } else {
            require_numbers(one, name);
        }
    }

    void require_numbers(const TreeJoint& one, const std::string& name) {
        if (!has_direction(one.axis)) {
            findings_.error(one.place, name + " has an axis without direction: expected a vector other than 0 0 0");
        }
        if (!one.lower || !one.upper || *one.lower >= *one.upper) {
            findings_.error(one.place, name + " has no range" +
                                           (one.lower && one.upper
                                                ? ", " + text_of(one, *one.lower) + " to " + text_of(one, *one.upper)
                                                : std::string()) +
                                           ": expected a lower limit below the upper one, or " + freeze_option(one));
        } else if (std::max(std::abs(*one.lower), std::abs(*one.upper)) > 20) {
            findings_.error(one.place, name + " has limits of " + to_text(*one.lower) + " and " + to_text(*one.upper) +
                                           " rad: more than three turns; are they in degrees? Expected radians");
        }
        if (!one.effort_nm || !(*one.effort_nm > 0)) {
            findings_.error(one.place, name + " has no torque: expected its greatest, above 0 (effort) [Nm], or " +
                                           freeze_option(one));
        }
    }

    void require_few() {
        if (chain_.joints.size() <= static_cast<std::size_t>(max_joints)) {
            return;
        }
        findings_.fail(joint(chain_.joints[static_cast<std::size_t>(max_joints)]).place,
                       "the arm has " + std::to_string(chain_.joints.size()) + " joints: expected at most " +
                           std::to_string(max_joints) + "; hold others by --freeze JOINT=DEG");
    }

    [[nodiscard]] bool is_of_rotor(const TreeJoint& one) const {
        return std::ranges::any_of(tree_.rotors, [&one](const TreeRotor& rotor) { return rotor.link == one.child; });
    }

    /// How a joint moves the child's frame.
    static RigidTransform motion(const TreeJoint& one, double position) {
        if (position == 0 || !has_direction(one.axis)) {
            return {};
        }
        if (one.kind == JointKind::prismatic) {
            return {identity(), position * unit(one.axis)};
        }
        const Matrix3 turned = rotation_about(one.axis, position);
        return {turned, one.anchor_m - turned * one.anchor_m};
    }

    static std::string text_of(const TreeJoint& one, double position) {
        return one.kind == JointKind::prismatic ? to_text(position, 6) + " m"
                                                : to_text(position * degrees_per_radian, 6) + " deg";
    }

    [[nodiscard]] std::string joint_names() const {
        std::string names;
        for (const TreeJoint& one : tree_.joints) {
            if (one.kind != JointKind::fixed) {
                names += (names.empty() ? "" : ", ") + excerpt(one.name);
            }
        }
        return names.empty() ? "a joint, and all are fixed" : names;
    }

    const KinematicTree& tree_;
    const ImportSettings& settings_;
    Findings& findings_;
    std::vector<std::vector<int>> below_;  ///< joints by their parent link
    std::map<int, double> frozen_;
    ArmChain chain_;
};

}  // namespace

ArmChain arm_chain(const KinematicTree& tree, int root, const ImportSettings& settings, Findings& findings) {
    return Search(tree, settings, findings).found(root);
}

}  // namespace downwash::robot_import
