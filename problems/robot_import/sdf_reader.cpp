#include "downwash/robot_import/sdf_reader.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <sdf/sdf.hh>
#include <string>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/robot_import/console_log.hpp"
#include "downwash/robot_import/mesh_path.hpp"
#include "downwash/robot_import/motor_plugins.hpp"
#include "downwash/robot_import/tree_graph.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash::robot_import {
namespace {

namespace fs = std::filesystem;

Vector3 vector_of(const ignition::math::Vector3d& v) {
    return {v.X(), v.Y(), v.Z()};
}

RigidTransform transform_of(const ignition::math::Pose3d& pose) {
    const auto& q = pose.Rot();
    return {rotation_of(std::array<double, 4>{q.W(), q.X(), q.Y(), q.Z()}), vector_of(pose.Pos())};
}

/// An element as XML, with all below it.
XmlElement xml_of(const sdf::ElementPtr& from, const Place& place) {
    XmlElement element;
    element.name = from->GetName();
    element.place = place;
    for (const sdf::ParamPtr& attribute : from->GetAttributes()) {
        element.attributes.emplace_back(attribute->GetKey(), attribute->GetAsString());
    }
    if (const sdf::ParamPtr value = from->GetValue()) {
        element.text = trimmed(value->GetAsString());
    }
    for (sdf::ElementPtr child = from->GetFirstElement(); child; child = child->GetNextElement()) {
        element.children.push_back(xml_of(child, {child->LineNumber().value_or(place.line), 1}));
    }
    return element;
}

/// Files that included files include are looked for by libsdformat's global settings; this sets them for a while.
class GlobalFinder {
 public:
    explicit GlobalFinder(const std::function<std::string(const std::string&)>& find)
        : before_(sdf::ParserConfig::GlobalConfig().FindFileCallback()) {
        sdf::ParserConfig::GlobalConfig().SetFindCallback(find);
    }
    ~GlobalFinder() { sdf::ParserConfig::GlobalConfig().SetFindCallback(before_); }
    GlobalFinder(const GlobalFinder&) = delete;
    GlobalFinder& operator=(const GlobalFinder&) = delete;

 private:
    std::function<std::string(const std::string&)> before_;
};

class SdfReader {
 public:
    SdfReader(const fs::path& file, Findings& findings) : file_(file), findings_(findings) {}

    KinematicTree read() {
        load();
        const sdf::Model* model = first_model();
        tree_.format = "SDF";
        tree_.name = model->Name();
        add_links(*model, "", {});
        add_joints(*model, "", {});
        findings_.throw_if_any();
        const int base = require_tree(tree_, findings_);
        add_model_frame(base, place_of(model->Element()));
        const XmlElement root = xml_of(model->Element(), place_of(model->Element()));
        add_motor_plugins(tree_, root, findings_);
        return std::move(tree_);
    }

 private:
    void load() {
        sdf::Console::Instance()->SetQuiet(true);
        sdf::ParserConfig config;
        const auto find = [this](const std::string& name) { return named_file(name, file_); };
        config.SetFindCallback(find);
        const GlobalFinder for_nested(find);
        const ConsoleLog quiet;  // of what is no SDF, libsdformat asks liburdfdom
        for (const sdf::Error& error : root_.Load(file_.string(), config)) {
            // Masses and inertias are checked with those of all formats.
            if (error.Code() != sdf::ErrorCode::LINK_INERTIA_INVALID) {
                findings_.error({error.LineNumber().value_or(1), 1},
                                error.Message() + " (libsdformat): expected SDF; `gz sdf --check FILE` says the same");
            }
        }
        findings_.throw_if_any();
    }

    const sdf::Model* first_model() {
        const sdf::Model* model = root_.Model();
        if (model == nullptr && root_.WorldCount() > 0 && root_.WorldByIndex(0)->ModelCount() == 1) {
            model = root_.WorldByIndex(0)->ModelByIndex(0);
        }
        if (model == nullptr) {
            findings_.fail({}, "has no <model>, or a world of several: expected one model, the vehicle with its arm");
        }
        return model;
    }

    /// Places in files that this one includes are not in it.
    [[nodiscard]] Place place_of(const sdf::ElementPtr& element) const {
        return element && element->FilePath() == file_.string() ? Place{element->LineNumber().value_or(1), 1} : Place{};
    }

    /// The place of a part in the frame of its model. @param relative_to empty: that frame
    template <class Part>
    RigidTransform pose_of(const Part& part, const std::string& relative_to = "") {
        ignition::math::Pose3d pose;
        for (const sdf::Error& error : part.SemanticPose().Resolve(pose, relative_to)) {
            findings_.error(place_of(part.Element()), error.Message() + " (libsdformat)");
        }
        return transform_of(pose);
    }

    /// @param scope of names in a model within a model, with "::"   @param outer its frame
    void add_links(const sdf::Model& model, const std::string& scope, const RigidTransform& outer) {
        for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
            const sdf::Link& from = *model.LinkByIndex(i);
            TreeLink link;
            link.name = scope + from.Name();
            link.place = place_of(from.Element());
            poses_.push_back(outer * pose_of(from));
            if (from.Element()->HasElement("inertial")) {
                const ignition::math::Inertiald& inertial = from.Inertial();
                const RigidTransform pose = transform_of(inertial.Pose());
                const auto& m = inertial.MassMatrix();
                const Vector3 d = vector_of(m.DiagonalMoments()), o = vector_of(m.OffDiagonalMoments());
                const Matrix3 own{{{d[0], o[0], o[1]}, {o[0], d[1], o[2]}, {o[1], o[2], d[2]}}};
                link.inertial = TreeInertial{m.Mass(), pose.position_m, pose.rotation * own * transposed(pose.rotation),
                                             place_of(from.Element()->GetElement("inertial"))};
            }
            for (std::uint64_t k = 0; k < from.CollisionCount(); ++k) {
                add_shape(link.collision, *from.CollisionByIndex(k)->Geom(), pose_of(*from.CollisionByIndex(k)),
                          place_of(from.CollisionByIndex(k)->Element()));
            }
            for (std::uint64_t k = 0; k < from.VisualCount(); ++k) {
                add_shape(link.visual, *from.VisualByIndex(k)->Geom(), pose_of(*from.VisualByIndex(k)),
                          place_of(from.VisualByIndex(k)->Element()));
            }
            tree_.links.push_back(std::move(link));
        }
        for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
            const sdf::Model& inner = *model.ModelByIndex(i);
            add_links(inner, scope + inner.Name() + "::", outer * pose_of(inner));
        }
    }

    void add_shape(std::vector<TreeShape>& shapes, const sdf::Geometry& geometry, const RigidTransform& pose,
                   const Place& place) const {
        TreeShape shape{{}, pose, place};
        switch (geometry.Type()) {
            case sdf::GeometryType::BOX:
                shape.form = Box{vector_of(geometry.BoxShape()->Size())};
                break;
            case sdf::GeometryType::CYLINDER:
                shape.form =
                    Cylinder{geometry.CylinderShape()->Radius(), geometry.CylinderShape()->Length(), {0, 0, 1}};
                break;
            case sdf::GeometryType::SPHERE:
                shape.form = Sphere{geometry.SphereShape()->Radius()};
                break;
            case sdf::GeometryType::CAPSULE: {
                const double half_m = 0.5 * geometry.CapsuleShape()->Length();
                shape.form = Capsule{geometry.CapsuleShape()->Radius(), {0, 0, -half_m}, {0, 0, half_m}};
                break;
            }
            case sdf::GeometryType::ELLIPSOID:
                shape.form = Box{2.0 * vector_of(geometry.EllipsoidShape()->Radii())};
                break;
            case sdf::GeometryType::MESH: {
                MeshReference mesh = mesh_reference(geometry.MeshShape()->Uri(), file_);
                mesh.scale = vector_of(geometry.MeshShape()->Scale());
                shape.form = std::move(mesh);
                break;
            }
            default:
                return;  // planes and height maps are of worlds
        }
        shapes.push_back(std::move(shape));
    }

    void add_joints(const sdf::Model& model, const std::string& scope, const RigidTransform& outer) {
        for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
            const sdf::Joint& from = *model.JointByIndex(i);
            std::string parent, child;
            if (!from.ResolveParentLink(parent).empty() || !from.ResolveChildLink(child).empty()) {
                findings_.error(place_of(from.Element()), "joint '" + excerpt(scope + from.Name()) +
                                                              "' has a parent or child that is no link: expected the "
                                                              "names of two links");
                continue;
            }
            TreeJoint joint;
            joint.name = scope + from.Name();
            joint.place = place_of(from.Element());
            if (parent == "world") {
                findings_.warn(joint.place,
                               "joint '" + excerpt(joint.name) + "' holds the model in its world: left out");
                continue;
            }
            joint.parent = tree_.link(scope + parent);
            joint.child = tree_.link(scope + child);
            if (joint.parent < 0 || joint.child < 0) {
                findings_.error(joint.place, "joint '" + excerpt(joint.name) + "' has the parent '" + excerpt(parent) +
                                                 "' and the child '" + excerpt(child) +
                                                 "': expected the names of two links");
                continue;
            }
            set_kind(joint, from);
            const RigidTransform& base = poses_[static_cast<std::size_t>(joint.parent)];
            const RigidTransform child_pose = poses_[static_cast<std::size_t>(joint.child)];
            joint.origin = base.inverse() * child_pose;
            const RigidTransform frame = outer * pose_of(from, "__model__");
            joint.anchor_m = child_pose.inverse().placed(frame.position_m);
            set_axis(joint, from, outer, child_pose);
            tree_.joints.push_back(std::move(joint));
        }
        for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
            const sdf::Model& inner = *model.ModelByIndex(i);
            add_joints(inner, scope + inner.Name() + "::", outer * pose_of(inner));
        }
    }

    static void set_kind(TreeJoint& joint, const sdf::Joint& from) {
        joint.kind_name = from.Element()->Get<std::string>("type");
        switch (from.Type()) {
            case sdf::JointType::FIXED:
                joint.kind = JointKind::fixed;
                break;
            case sdf::JointType::REVOLUTE:
                joint.kind = JointKind::revolute;
                break;
            case sdf::JointType::CONTINUOUS:
                joint.kind = JointKind::continuous;
                break;
            case sdf::JointType::PRISMATIC:
                joint.kind = JointKind::prismatic;
                break;
            case sdf::JointType::BALL:
                joint.kind = JointKind::ball;
                break;
            default:
                joint.kind = JointKind::other;
        }
    }

    void set_axis(TreeJoint& joint, const sdf::Joint& from, const RigidTransform& outer,
                  const RigidTransform& child_pose) {
        const sdf::JointAxis* axis = from.Axis();
        if (axis == nullptr) {
            return;
        }
        ignition::math::Vector3d direction;
        for (const sdf::Error& error : axis->ResolveXyz(direction, "__model__")) {
            findings_.error(joint.place, error.Message() + " (libsdformat)");
        }
        joint.axis = transposed(child_pose.rotation) * (outer.rotation * vector_of(direction));
        constexpr double endless = 1e15;  // libsdformat has 1e16 where a file has no limit
        if (std::abs(axis->Lower()) < endless && std::abs(axis->Upper()) < endless) {
            joint.lower = axis->Lower();
            joint.upper = axis->Upper();
        } else if (joint.kind == JointKind::revolute) {
            joint.kind = JointKind::continuous;
            joint.kind_name += " without <limit>";
        }
        if (std::isfinite(axis->Effort()) && axis->Effort() > 0) {
            joint.effort_nm = axis->Effort();
        }
        if (std::isfinite(axis->MaxVelocity()) && axis->MaxVelocity() > 0) {
            joint.velocity_rad_s = axis->MaxVelocity();
        }
        joint.damping_nm_s = axis->Damping();
        joint.friction_nm = axis->Friction();
    }

    /// Places count in the axes of the model, whatever those of its first link are.
    void add_model_frame(int base, const Place& place) {
        TreeLink frame;
        frame.name = "__model__";
        frame.place = tree_.links[static_cast<std::size_t>(base)].place;
        TreeJoint joint;
        joint.name = "__model__ to " + tree_.links[static_cast<std::size_t>(base)].name;
        joint.place = place;
        joint.kind_name = "fixed";
        joint.parent = static_cast<int>(tree_.links.size());
        joint.child = base;
        joint.origin = poses_[static_cast<std::size_t>(base)];
        tree_.links.push_back(std::move(frame));
        tree_.joints.push_back(std::move(joint));
    }

    const fs::path& file_;
    Findings& findings_;
    sdf::Root root_;
    KinematicTree tree_;
    std::vector<RigidTransform> poses_;  ///< of each link, in the frame of the first model
};

}  // namespace

KinematicTree read_sdf(const fs::path& file, Findings& findings) {
    return SdfReader(file, findings).read();
}

}  // namespace downwash::robot_import
