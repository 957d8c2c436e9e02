#include "downwash/robot_import/mjcf_reader.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash::robot_import {
namespace {

namespace fs = std::filesystem;

/// Keeps warnings of MuJoCo from its log file and from standard error.
class QuietMujoco {
 public:
    QuietMujoco() : before_(mju_user_warning) {
        mju_user_warning = [](const char*) {};
    }
    ~QuietMujoco() { mju_user_warning = before_; }
    QuietMujoco(const QuietMujoco&) = delete;
    QuietMujoco& operator=(const QuietMujoco&) = delete;

 private:
    void (*before_)(const char*);
};

using Model = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;

/// The number behind a word of a message: 12 in "line 12, column 4" and in "line = 12". 1 without one.
int number_after(const std::string& message, std::string_view word) {
    const std::size_t at = message.find(word);
    if (at == std::string::npos) {
        return 1;
    }
    std::string_view rest = std::string_view(message).substr(at + word.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" ="), rest.size()));
    const std::string_view digits = rest.substr(0, rest.find_first_not_of("0123456789"));
    return std::max(parse_number<int>(digits).value_or(1), 1);
}

Model compiled(const fs::path& file, Findings& findings) {
    const QuietMujoco quiet;
    std::array<char, 1024> error{};
    Model model(mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())), &mj_deleteModel);
    if (!model) {
        std::string message(error.data());
        std::ranges::replace(message, '\n', ' ');
        findings.fail({number_after(message, "line"), number_after(message, "column")},
                      "MuJoCo does not compile this model (" + std::string(trimmed(message)) +
                          "): expected an MJCF file that MuJoCo " + std::string(mj_versionString()) + " opens");
    }
    return model;
}

Vector3 vector_at(const mjtNum* numbers, int index) {
    const mjtNum* v = numbers + 3 * static_cast<std::ptrdiff_t>(index);
    return {v[0], v[1], v[2]};
}

RigidTransform transform_at(const mjtNum* positions, const mjtNum* quaternions, int index) {
    const mjtNum* q = quaternions + 4 * static_cast<std::ptrdiff_t>(index);
    return {rotation_of(std::array<double, 4>{q[0], q[1], q[2], q[3]}), vector_at(positions, index)};
}

class MjcfReader {
 public:
    MjcfReader(const mjModel& model, const XmlElement& root, Findings& findings)
        : m_(model), findings_(findings), link_of_body_(static_cast<std::size_t>(model.nbody), -1) {
        for_each_element(root, [this](const XmlElement& element) {
            if (const auto name = element.attribute("name")) {
                places_.emplace(std::pair(element.name, *name), element.place);
                const XmlElement* inertial = element.name == "body" ? element.child("inertial") : nullptr;
                if (const auto full = inertial != nullptr ? inertial->attribute("fullinertia") : std::nullopt) {
                    inertials_.emplace(*name, *full);
                }
            }
        });
        tree_.name = root.attribute("model").value_or("");
        tree_.format = "MJCF";
    }

    KinematicTree read() {
        const int base = base_body();
        for (int body = base; body < m_.nbody; ++body) {  // a body follows its parent
            if (body == base || link_of_body_[static_cast<std::size_t>(m_.body_parentid[body])] >= 0) {
                add_body(body, body == base);
            }
        }
        add_shapes();
        add_sites();
        add_actuators();
        return std::move(tree_);
    }

 private:
    [[nodiscard]] std::string name_of(int type, int id, const char* what) const {
        const char* name = mj_id2name(&m_, type, id);
        return name != nullptr && *name != 0 ? std::string(name) : std::string(what) + std::to_string(id);
    }
    [[nodiscard]] Place place_of(const std::string& element, const std::string& name) const {
        const auto found = places_.find({element, name});
        return found == places_.end() ? Place{} : found->second;
    }

    /// The body that floats; the only one of the world if none does.
    int base_body() {
        int floating = -1, top = -1;
        std::string names;
        for (int body = 1; body < m_.nbody; ++body) {
            const int joint = m_.body_jntadr[body];
            if (m_.body_jntnum[body] == 1 && m_.jnt_type[joint] == mjJNT_FREE) {
                floating = floating < 0 ? body : floating;
            }
            if (m_.body_parentid[body] == 0) {
                top = top < 0 ? body : 0;
                names += (names.empty() ? "" : ", ") + excerpt(name_of(mjOBJ_BODY, body, "body_"));
            }
        }
        if (floating >= 0) {
            return floating;
        }
        if (top <= 0) {
            findings_.fail({}, names.empty() ? "has no body: expected a vehicle"
                                             : "has the bodies " + names +
                                                   " in its world: expected <freejoint/> in that of the vehicle");
        }
        return top;
    }

    void add_body(int body, bool is_base) {
        TreeLink link;
        link.name = name_of(mjOBJ_BODY, body, "body_");
        link.place = place_of("body", link.name);
        if (m_.body_mass[body] > 0) {
            link.inertial = inertial_of(body, link);
        }
        if (is_base) {
            if (m_.body_jntnum[body] > 0 && m_.jnt_type[m_.body_jntadr[body]] != mjJNT_FREE) {
                findings_.warn(link.place, "joints of body '" + excerpt(link.name) +
                                               "', the base, are left out: Downwash lets it fly");
            }
            link_of_body_[static_cast<std::size_t>(body)] = add(std::move(link));
            return;
        }
        int parent = link_of_body_[static_cast<std::size_t>(m_.body_parentid[body])];
        RigidTransform origin = transform_at(m_.body_pos, m_.body_quat, body);
        const int count = m_.body_jntnum[body], first = m_.body_jntadr[body];
        // A body with several joints hangs on links without mass between them.
        for (int k = 0; k + 1 < count; ++k) {
            TreeLink between;
            between.name = link.name + " behind " + name_of(mjOBJ_JOINT, first + k, "joint_");
            between.place = link.place;
            const int index = add(std::move(between));
            add_joint(first + k, parent, index, origin);
            parent = index;
            origin = {};
        }
        const Place place = link.place;
        const std::string name = link.name;
        const int index = add(std::move(link));
        link_of_body_[static_cast<std::size_t>(body)] = index;
        if (count > 0) {
            add_joint(first + count - 1, parent, index, origin);
            return;
        }
        TreeJoint fixed;
        fixed.name = name + " fixed";
        fixed.kind_name = "fixed";
        fixed.place = place;
        fixed.parent = parent;
        fixed.child = index;
        fixed.origin = origin;
        tree_.joints.push_back(std::move(fixed));
    }

    [[nodiscard]] TreeInertial inertial_of(int body, const TreeLink& link) const {
        const RigidTransform pose = transform_at(m_.body_ipos, m_.body_iquat, body);
        const Vector3 moments = vector_at(m_.body_inertia, body);
        const Matrix3 own{{{moments[0], 0, 0}, {0, moments[1], 0}, {0, 0, moments[2]}}};
        const Matrix3 compiled = pose.rotation * own * transposed(pose.rotation);
        return {m_.body_mass[body], pose.position_m, as_written(link.name, moments).value_or(compiled), link.place};
    }

    /// The full inertia of a body as the file has it: MuJoCo knows its principal axes to eight digits only. Empty where
    /// the file has none, or where MuJoCo made another one of it.
    [[nodiscard]] std::optional<Matrix3> as_written(const std::string& body, const Vector3& moments) const {
        const auto found = inertials_.find(body);
        if (found == inertials_.end()) {
            return std::nullopt;
        }
        std::array<double, 6> m{};
        std::string_view rest = found->second;
        for (double& moment : m) {
            moment = number_in(take_word(rest)).value_or(0);
        }
        const double sum = moments[0] + moments[1] + moments[2];
        constexpr double rounding = 1e-9;
        if (std::abs(m[0] + m[1] + m[2] - sum) > rounding * sum) {
            return std::nullopt;
        }
        return Matrix3{{{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}}};
    }

    int add(TreeLink link) {
        tree_.links.push_back(std::move(link));
        return static_cast<int>(tree_.links.size()) - 1;
    }

    void add_joint(int id, int parent, int child, const RigidTransform& origin) {
        TreeJoint joint;
        joint.name = name_of(mjOBJ_JOINT, id, "joint_");
        joint.place = place_of("joint", joint.name);
        joint.parent = parent;
        joint.child = child;
        joint.origin = origin;
        joint.anchor_m = vector_at(m_.jnt_pos, id);
        joint.axis = vector_at(m_.jnt_axis, id);
        const bool is_limited = m_.jnt_limited[id] != 0;
        const int type = m_.jnt_type[id];
        joint.kind = type == mjJNT_HINGE   ? (is_limited ? JointKind::revolute : JointKind::continuous)
                     : type == mjJNT_SLIDE ? JointKind::prismatic
                     : type == mjJNT_BALL  ? JointKind::ball
                                           : JointKind::floating;
        joint.kind_name = type == mjJNT_HINGE   ? (is_limited ? "hinge" : "hinge without range")
                          : type == mjJNT_SLIDE ? "slide"
                          : type == mjJNT_BALL  ? "ball"
                                                : "free";
        if (is_limited && (type == mjJNT_HINGE || type == mjJNT_SLIDE)) {
            const double zero = m_.qpos0[m_.jnt_qposadr[id]];
            joint.lower = m_.jnt_range[2 * id] - zero;
            joint.upper = m_.jnt_range[2 * id + 1] - zero;
            if (zero != 0) {
                findings_.warn(joint.place, "joint '" + excerpt(joint.name) + "' has ref " + to_text(zero, 6) +
                                                ": in the robot file that place is zero");
            }
        }
        joint.damping_nm_s = m_.dof_damping[m_.jnt_dofadr[id]];
        joint.friction_nm = m_.dof_frictionloss[m_.jnt_dofadr[id]];
        joint_index_[id] = static_cast<int>(tree_.joints.size());
        tree_.joints.push_back(std::move(joint));
    }

    void add_shapes() {
        for (int geom = 0; geom < m_.ngeom; ++geom) {
            const int link = link_of_body_[static_cast<std::size_t>(m_.geom_bodyid[geom])];
            if (link < 0) {
                continue;
            }
            TreeLink& owner = tree_.links[static_cast<std::size_t>(link)];
            TreeShape shape{{}, transform_at(m_.geom_pos, m_.geom_quat, geom), owner.place};
            if (set_form(shape, geom)) {
                const bool collides = m_.geom_contype[geom] != 0 || m_.geom_conaffinity[geom] != 0;
                (collides ? owner.collision : owner.visual).push_back(std::move(shape));
            }
        }
    }

    bool set_form(TreeShape& shape, int geom) {
        const Vector3 size = vector_at(m_.geom_size, geom);
        switch (m_.geom_type[geom]) {
            case mjGEOM_BOX:
            case mjGEOM_ELLIPSOID:
                shape.form = Box{2.0 * size};
                return true;
            case mjGEOM_SPHERE:
                shape.form = Sphere{size[0]};
                return true;
            case mjGEOM_CYLINDER:
                shape.form = Cylinder{size[0], 2 * size[1], {0, 0, 1}};
                return true;
            case mjGEOM_CAPSULE:
                shape.form = Capsule{size[0], {0, 0, -size[1]}, {0, 0, size[1]}};
                return true;
            case mjGEOM_MESH: {
                shape.form = compiled_mesh(m_.geom_dataid[geom]);
                return true;
            }
            default:
                return false;  // planes and height fields are of worlds
        }
    }

    /// A mesh with its vertices, which MuJoCo has scaled and moved to their centre: one piece, since MuJoCo itself
    /// collides with the convex hull of all of it.
    [[nodiscard]] MeshReference compiled_mesh(int mesh) const {
        MeshReference compiled;
        compiled.file = name_of(mjOBJ_MESH, mesh, "mesh_");
        std::vector<Vector3>& vertices_m = compiled.pieces.emplace_back();
        for (int i = 0; i < m_.mesh_vertnum[mesh]; ++i) {
            const float* v = m_.mesh_vert + 3 * static_cast<std::ptrdiff_t>(m_.mesh_vertadr[mesh] + i);
            vertices_m.push_back({v[0], v[1], v[2]});
        }
        return compiled;
    }

    void add_sites() {
        for (int site = 0; site < m_.nsite; ++site) {
            const int parent = link_of_body_[static_cast<std::size_t>(m_.site_bodyid[site])];
            const std::string name = name_of(mjOBJ_SITE, site, "site_");
            if (parent < 0 || tree_.link(name) >= 0) {
                continue;
            }
            TreeLink link;
            link.name = name;
            link.place = place_of("site", name);
            TreeJoint joint;
            joint.name = name + " fixed";
            joint.kind_name = "fixed";
            joint.place = link.place;
            joint.parent = parent;
            joint.origin = transform_at(m_.site_pos, m_.site_quat, site);
            joint.child = add(std::move(link));
            tree_.joints.push_back(std::move(joint));
        }
    }

    void add_actuators() {
        for (int actuator = 0; actuator < m_.nu; ++actuator) {
            const int target = m_.actuator_trnid[2 * actuator];
            if (m_.actuator_trntype[actuator] == mjTRN_JOINT && joint_index_.contains(target)) {
                add_torque(actuator, tree_.joints[static_cast<std::size_t>(joint_index_[target])]);
            } else if (m_.actuator_trntype[actuator] == mjTRN_SITE) {
                add_rotor(actuator, target);
            }
        }
    }

    /// The greatest force of an actuator, before its gear; empty if nothing bounds it.
    [[nodiscard]] std::optional<std::pair<double, double>> force_range(int actuator) const {
        std::optional<std::pair<double, double>> range;
        const auto bound = [&range](double low, double high) {
            range =
                range ? std::pair(std::max(low, range->first), std::min(high, range->second)) : std::pair(low, high);
        };
        if (m_.actuator_forcelimited[actuator] != 0) {
            bound(m_.actuator_forcerange[2 * actuator], m_.actuator_forcerange[2 * actuator + 1]);
        }
        const bool is_motor =
            m_.actuator_gaintype[actuator] == mjGAIN_FIXED && m_.actuator_biastype[actuator] == mjBIAS_NONE;
        if (is_motor && m_.actuator_ctrllimited[actuator] != 0) {
            const double gain = m_.actuator_gainprm[static_cast<std::ptrdiff_t>(actuator) * mjNGAIN];
            bound(gain * m_.actuator_ctrlrange[2 * actuator], gain * m_.actuator_ctrlrange[2 * actuator + 1]);
        }
        return range;
    }

    void add_torque(int actuator, TreeJoint& joint) const {
        if (const auto range = force_range(actuator)) {
            const double gear = std::abs(m_.actuator_gear[6 * static_cast<std::ptrdiff_t>(actuator)]);
            joint.effort_nm = gear * std::min(std::abs(range->first), std::abs(range->second));
        }
    }

    void add_rotor(int actuator, int site) {
        const int link = tree_.link(name_of(mjOBJ_SITE, site, "site_"));
        const mjtNum* gear = m_.actuator_gear + 6 * static_cast<std::ptrdiff_t>(actuator);
        const Vector3 force{gear[0], gear[1], gear[2]}, torque{gear[3], gear[4], gear[5]};
        if (link < 0 || !has_direction(force)) {
            return;  // no thruster of this robot
        }
        TreeRotor rotor;
        rotor.name = name_of(mjOBJ_ACTUATOR, actuator, "actuator_");
        rotor.link = link;
        rotor.axis = unit(force);
        rotor.place = place_of("motor", rotor.name);
        for (const char* element : {"general", "site"}) {
            if (rotor.place.line == 1) {
                rotor.place = place_of(element, rotor.name);
            }
        }
        rotor.source = "actuators of sites";
        // The torque of drag on the vehicle is against the spin.
        const double drag = dot(torque, rotor.axis);
        if (drag != 0) {
            rotor.spin = drag < 0 ? 1 : -1;
            rotor.torque_ratio_m = std::abs(drag) / length_of(force);
        }
        if (const auto range = force_range(actuator)) {
            rotor.min_thrust_n = std::max(0.0, range->first * length_of(force));
            rotor.max_thrust_n = range->second * length_of(force);
        }
        if (m_.actuator_dyntype[actuator] == mjDYN_FILTER) {
            rotor.time_constant_s = m_.actuator_dynprm[static_cast<std::ptrdiff_t>(actuator) * mjNDYN];
        }
        tree_.rotors.push_back(std::move(rotor));
    }

    const mjModel& m_;
    Findings& findings_;
    KinematicTree tree_;
    std::vector<int> link_of_body_;
    std::map<int, int> joint_index_;                               ///< of MuJoCo's joints
    std::map<std::pair<std::string, std::string>, Place> places_;  ///< of elements by their kind and name
    std::map<std::string, std::string> inertials_;                 ///< fullinertia of bodies by their names
};

}  // namespace

KinematicTree read_mjcf(const fs::path& file, const XmlElement& root, Findings& findings) {
    const Model model = compiled(file, findings);
    return MjcfReader(*model, root, findings).read();
}

}  // namespace downwash::robot_import
