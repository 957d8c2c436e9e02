#include "downwash/robot_import/urdf_reader.hpp"

#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/robot_import/console_log.hpp"
#include "downwash/robot_import/mesh_path.hpp"
#include "downwash/robot_import/motor_plugins.hpp"
#include "downwash/robot_import/tree_graph.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash::robot_import {
namespace {

struct NumbersOf {
    std::string_view attribute;
    std::size_t count;
};
constexpr std::array numeric{NumbersOf{"xyz", 3},      NumbersOf{"rpy", 3},     NumbersOf{"size", 3},
                             NumbersOf{"scale", 3},    NumbersOf{"radius", 1},  NumbersOf{"length", 1},
                             NumbersOf{"ixx", 1},      NumbersOf{"ixy", 1},     NumbersOf{"ixz", 1},
                             NumbersOf{"iyy", 1},      NumbersOf{"iyz", 1},     NumbersOf{"izz", 1},
                             NumbersOf{"lower", 1},    NumbersOf{"upper", 1},   NumbersOf{"effort", 1},
                             NumbersOf{"velocity", 1}, NumbersOf{"damping", 1}, NumbersOf{"friction", 1}};

void check_numbers(const XmlElement& element, Findings& findings) {
    const auto check = [&](const std::string& attribute, const std::string& value, std::size_t count) {
        std::string_view rest = value;
        std::size_t found = 0;
        bool are_numbers = true;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            are_numbers = are_numbers && number_in(word).has_value();
            ++found;
        }
        if (!are_numbers || found != count) {
            findings.error(element.place, attribute + "=\"" + excerpt(value) + "\" of <" + excerpt(element.name) +
                                              ">: expected " +
                                              (count == 1 ? "a number" : std::to_string(count) + " numbers") +
                                              " with decimal points and blanks between them");
        }
    };
    for (const auto& [attribute, value] : element.attributes) {
        if (element.name == "mass" && attribute == "value") {
            check(attribute, value, 1);
        }
        for (const NumbersOf& known : numeric) {
            if (attribute == known.attribute) {
                check(attribute, value, known.count);
            }
        }
    }
    for (const XmlElement& child : element.children) {
        check_numbers(child, findings);
    }
}

void check_link(const XmlElement& link, Findings& findings) {
    const std::string name = "link '" + excerpt(link.attribute("name").value_or("")) + "'";
    if (const XmlElement* inertial = link.child("inertial")) {
        for (const char* part : {"mass", "inertia"}) {
            if (inertial->child(part) == nullptr) {
                findings.error(inertial->place, name + ": <inertial> has no <" + part + ">: expected one");
            }
        }
        if (const XmlElement* inertia = inertial->child("inertia")) {
            for (const char* moment : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
                if (!inertia->attribute(moment)) {
                    findings.error(inertia->place,
                                   name + ": <inertia> has no " + moment + ": expected all six moments [kg m2]");
                }
            }
        }
    }
    check_numbers(link, findings);
}

void check_joint(const XmlElement& joint, Findings& findings) {
    const std::string name = "joint '" + excerpt(joint.attribute("name").value_or("")) + "'";
    const std::string type = joint.attribute("type").value_or("");
    const std::vector<std::string_view> types{"fixed", "revolute", "continuous", "prismatic", "floating", "planar"};
    if (std::ranges::find(types, type) == types.end()) {
        findings.error(joint.place, name + " has the type '" + excerpt(type) + "': expected " + joined_names(types) +
                                        (type.empty() ? "" : did_you_mean(type, types)));
    }
    const XmlElement* limit = joint.child("limit");
    if ((type == "revolute" || type == "prismatic") && limit == nullptr) {
        findings.error(joint.place, name + " is " + type +
                                        " without <limit>: expected <limit lower=\"\" upper=\"\" effort=\"\" "
                                        "velocity=\"\"/> [rad, Nm, rad/s]");
    }
    if (limit != nullptr) {
        for (const char* part : {"effort", "velocity"}) {
            if (!limit->attribute(part)) {
                findings.error(limit->place, name + ": <limit> has no " + part + ": expected one above 0");
            }
        }
    }
    if (const XmlElement* mimic = joint.child("mimic"); mimic != nullptr && !mimic->attribute("joint")) {
        findings.error(mimic->place, name + ": <mimic> names no joint: expected joint=\"...\"");
    }
    check_numbers(joint, findings);
}

/// The names and places of links and joints, and which hangs on which.
KinematicTree skeleton_of(const XmlElement& root, Findings& findings) {
    KinematicTree tree;
    tree.format = "URDF";
    tree.name = root.attribute("name").value_or("");
    for (const XmlElement* link : root.all("link")) {
        tree.links.push_back({link->attribute("name").value_or(""), link->place, {}, {}, {}});
        check_link(*link, findings);
    }
    for (const XmlElement* element : root.all("joint")) {
        TreeJoint joint;
        joint.name = element->attribute("name").value_or("");
        joint.place = element->place;
        joint.kind_name = element->attribute("type").value_or("");
        check_joint(*element, findings);
        bool is_complete = true;
        for (const auto& [part, end] : {std::pair{"parent", &joint.parent}, std::pair{"child", &joint.child}}) {
            const XmlElement* found = element->child(part);
            const std::string name = found != nullptr ? found->attribute("link").value_or("") : "";
            *end = tree.link(name);
            if (*end < 0) {
                is_complete = false;
                findings.error(found != nullptr ? found->place : element->place,
                               "joint '" + excerpt(joint.name) + "' has the " + part + " '" + excerpt(name) +
                                   "', and there is no such link: expected the name of a <link>");
            }
        }
        if (is_complete) {
            tree.joints.push_back(std::move(joint));
        }
    }
    findings.throw_if_any();
    return tree;
}

Vector3 vector_of(const urdf::Vector3& v) {
    return {v.x, v.y, v.z};
}

RigidTransform transform_of(const urdf::Pose& pose) {
    const urdf::Rotation& r = pose.rotation;
    return {rotation_of(std::array<double, 4>{r.w, r.x, r.y, r.z}), vector_of(pose.position)};
}

std::optional<TreeInertial> inertial_of(const urdf::Link& link, const Place& place) {
    if (!link.inertial) {
        return std::nullopt;
    }
    const urdf::Inertial& from = *link.inertial;
    const RigidTransform pose = transform_of(from.origin);
    const Matrix3 own{{{from.ixx, from.ixy, from.ixz}, {from.ixy, from.iyy, from.iyz}, {from.ixz, from.iyz, from.izz}}};
    return TreeInertial{from.mass, pose.position_m, pose.rotation * own * transposed(pose.rotation), place};
}

std::optional<TreeShape> shape_of(const urdf::Geometry* geometry, const urdf::Pose& pose, const Place& place,
                                  const std::filesystem::path& file) {
    if (geometry == nullptr) {
        return std::nullopt;
    }
    TreeShape shape{{}, transform_of(pose), place};
    if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) {
        shape.form = Box{vector_of(box->dim)};
    } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) {
        shape.form = Cylinder{cylinder->radius, cylinder->length, {0, 0, 1}};
    } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) {
        shape.form = Sphere{sphere->radius};
    } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
        MeshReference reference = mesh_reference(mesh->filename, file);
        reference.scale = vector_of(mesh->scale);
        shape.form = std::move(reference);
    }
    return shape;
}

/// @param parts collision_array or visual_array   @param elements in the same order
template <class Parts>
void add_shapes(std::vector<TreeShape>& shapes, const Parts& parts, const std::vector<const XmlElement*>& elements,
                const std::filesystem::path& file) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Place place = i < elements.size() ? elements[i]->place : Place{};
        if (auto shape = shape_of(parts[i]->geometry.get(), parts[i]->origin, place, file)) {
            shapes.push_back(std::move(*shape));
        }
    }
}

JointKind kind_of(const urdf::Joint& joint) {
    switch (joint.type) {
        case urdf::Joint::REVOLUTE:
            return JointKind::revolute;
        case urdf::Joint::CONTINUOUS:
            return JointKind::continuous;
        case urdf::Joint::PRISMATIC:
            return JointKind::prismatic;
        case urdf::Joint::FLOATING:
            return JointKind::floating;
        case urdf::Joint::PLANAR:
            return JointKind::planar;
        case urdf::Joint::FIXED:
            return JointKind::fixed;
        default:
            return JointKind::other;
    }
}

void fill(TreeJoint& joint, const urdf::Joint& from) {
    joint.kind = kind_of(from);
    joint.origin = transform_of(from.parent_to_joint_origin_transform);
    joint.axis = vector_of(from.axis);
    if (from.limits) {
        if (joint.kind != JointKind::continuous) {
            joint.lower = from.limits->lower;
            joint.upper = from.limits->upper;
        }
        joint.effort_nm = from.limits->effort;
        joint.velocity_rad_s = from.limits->velocity;
    }
    if (from.dynamics) {
        joint.damping_nm_s = from.dynamics->damping;
        joint.friction_nm = from.dynamics->friction;
    }
    if (from.mimic) {
        joint.mimic = TreeMimic{from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    }
}

/// Where an error of liburdfdom is: at the link or joint that it names.
Place place_named_in(const std::string& said, const KinematicTree& tree) {
    const auto is_named = [&said](const auto& part) { return said.find("[" + part.name + "]") != std::string::npos; };
    for (const TreeJoint& joint : tree.joints) {
        if (is_named(joint)) {
            return joint.place;
        }
    }
    for (const TreeLink& link : tree.links) {
        if (is_named(link)) {
            return link.place;
        }
    }
    return {};
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& text, const KinematicTree& tree, Findings& findings) {
    ConsoleLog log;
    std::string why;
    try {
        if (urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text)) {
            return model;
        }
        why = log.said();
    } catch (const std::exception& error) {
        why = error.what();
    }
    findings.fail(place_named_in(why, tree), "is no URDF that liburdfdom reads: " + (why.empty() ? "no reason" : why) +
                                                 "; `check_urdf FILE` says the same");
}

}  // namespace

KinematicTree read_urdf(const std::filesystem::path& file, const std::string& text, const XmlElement& root,
                        Findings& findings) {
    KinematicTree tree = skeleton_of(root, findings);
    require_tree(tree, findings);
    const urdf::ModelInterfaceSharedPtr model = parsed(text, tree, findings);
    const std::vector<const XmlElement*> elements = root.all("link");
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        TreeLink& link = tree.links[i];
        const urdf::LinkConstSharedPtr from = model->getLink(link.name);
        const XmlElement* inertial = elements[i]->child("inertial");
        link.inertial = inertial_of(*from, inertial != nullptr ? inertial->place : link.place);
        add_shapes(link.collision, from->collision_array, elements[i]->all("collision"), file);
        add_shapes(link.visual, from->visual_array, elements[i]->all("visual"), file);
    }
    for (TreeJoint& joint : tree.joints) {
        fill(joint, *model->getJoint(joint.name));
    }
    add_motor_plugins(tree, root, findings);
    return tree;
}

}  // namespace downwash::robot_import
