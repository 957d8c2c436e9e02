#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <cstring>
#include <iomanip>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "downwash/dynamics/space_plant.hpp"

// A plant in space in a general-purpose rigid-body simulator. Its free joint has our coordinates and speeds: velocity
// in world axes, angular velocity in body axes.

namespace downwash::test {

/// Three numbers as MJCF has them.
inline std::string text_of(const Vector3& v) {
    std::ostringstream text;
    text << std::setprecision(17) << v[0] << ' ' << v[1] << ' ' << v[2];
    return text.str();
}

/// A body's mass and inertia as MJCF. Principal axes are ours: those that MuJoCo finds by itself are off by some 1e-6
/// rad.
inline std::string inertial(const SpaceBody& body, const Vector3& center_m) {
    Eigen::Matrix3d inertia;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            inertia(i, k) = body.inertia_kg_m2[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) {
        axes.col(2) = -axes.col(2);
    }
    const Eigen::Quaterniond turn(axes);
    const Eigen::Vector3d& moments = solver.eigenvalues();
    std::ostringstream xml;
    xml << std::setprecision(17) << "<inertial pos='" << text_of(center_m) << "' quat='" << turn.w() << ' ' << turn.x()
        << ' ' << turn.y() << ' ' << turn.z() << "' mass='" << body.mass_kg << "' diaginertia='" << moments[0] << ' '
        << moments[1] << ' ' << moments[2] << "'/>";
    return xml.str();
}

/// The plant as MJCF; a motor on each rotor's axis, with its lag and drag torque.
/// @param flywheels bodies within the multirotor: those of rotors that really spin
inline std::string space_mjcf(const SpacePlant& plant, double step_s, const std::string& flywheels = {}) {
    std::ostringstream xml;
    xml << std::setprecision(17) << "<mujoco><compiler angle='radian' inertiafromgeom='false'/><option timestep='"
        << step_s << "' integrator='RK4' gravity='0 0 -9.80665'><flag contact='disable' constraint='disable'/></option>"
        << "<worldbody><body name='multirotor'><freejoint/>" << inertial(plant.multirotor, {0, 0, 0});
    for (std::size_t i = 0; i < plant.rotors.size(); ++i) {
        xml << "<site name='rotor" << i << "' pos='" << text_of(plant.rotors[i].position_m) << "' zaxis='"
            << text_of(plant.rotors[i].axis) << "'/>";
    }
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const SpaceLink& link = plant.links[i];
        xml << "<body pos='" << text_of(link.joint_m) << "'><joint name='joint" << i << "' type='hinge' axis='"
            << text_of(link.axis) << "' damping='" << link.viscous_friction_nm_s << "'/>"
            << inertial(link.body, link.center_of_mass_m);
    }
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        xml << "</body>";
    }
    xml << flywheels << "</body></worldbody><actuator>";
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        xml << "<motor joint='joint" << i << "'/>";
    }
    for (std::size_t i = 0; i < plant.rotors.size(); ++i) {
        const SpaceRotor& rotor = plant.rotors[i];
        xml << "<general site='rotor" << i << "' gear='0 0 1 0 0 " << -rotor.spin * rotor.drag_torque_m << "'";
        if (plant.time_constant_s > 0) {
            xml << " dyntype='filter' dynprm='" << plant.time_constant_s << "'";
        }
        xml << "/>";
    }
    xml << "</actuator></mujoco>";
    return xml.str();
}

/// A plant in a MuJoCo world of its own, integrated by RK4.
class MujocoSpace {
 public:
    /// @throws std::runtime_error with MuJoCo's words
    explicit MujocoSpace(const std::string& xml) {
        const auto files = std::make_unique<mjVFS>();
        mj_defaultVFS(files.get());
        mj_makeEmptyFileVFS(files.get(), "plant.xml", static_cast<int>(xml.size()));
        std::memcpy(files->filedata[0], xml.data(), xml.size());
        char error[1000] = "";
        model_.reset(mj_loadXML("plant.xml", files.get(), error, sizeof(error)));
        mj_deleteVFS(files.get());
        if (model_ == nullptr) {
            throw std::runtime_error(std::string("no plant for MuJoCo: ") + error);
        }
        data_.reset(mj_makeData(model_.get()));
    }
    void step(int steps) {
        for (int i = 0; i < steps; ++i) {
            mj_step(model_.get(), data_.get());
        }
    }
    mjData* data() { return data_.get(); }
    mjModel* model() { return model_.get(); }

 private:
    struct Free {
        void operator()(mjModel* model) const { mj_deleteModel(model); }
        void operator()(mjData* data) const { mj_deleteData(data); }
    };
    std::unique_ptr<mjModel, Free> model_;
    std::unique_ptr<mjData, Free> data_;
};

}  // namespace downwash::test
