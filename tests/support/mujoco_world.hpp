#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "downwash/simulation/world.hpp"

namespace downwash::test {

/// The robot as MJCF: two slides, a hinge for pitch, a hinge for the arm; a motor on each rotor's axis, with its lag.
/// @param world changes masses, inertias, centre of mass, thrust and lag, in MuJoCo's own terms
inline std::string mjcf(const Robot& robot, double step_s, const World& world = {}) {
    const double ia = robot.multirotor.pitch_inertia_kg_m2 * (1 + world.inertia_scale);
    const double ib = robot.arm.inertia_kg_m2 * (1 + world.inertia_scale) * (1 + world.arm_mass_scale);
    const double lag_s = robot.rotors.time_constant_s + world.rotor_time_constant_s;
    std::ostringstream xml;
    xml << std::setprecision(17);
    xml << "<mujoco><compiler angle='radian' inertiafromgeom='false'/>"
        << "<option timestep='" << step_s << "' integrator='RK4' gravity='0 0 -9.80665'>"
        << "<flag contact='disable' constraint='disable'/></option>"
        << "<worldbody><body name='multirotor'>"
        << "<joint name='x' type='slide' axis='1 0 0'/><joint name='z' type='slide' axis='0 0 1'/>"
        << "<joint name='pitch' type='hinge' axis='0 1 0'/>"
        << "<inertial pos='" << world.center_of_mass_x_m << " 0 " << world.center_of_mass_z_m << "' mass='"
        << robot.multirotor.mass_kg * (1 + world.mass_scale) << "' diaginertia='" << ia << ' ' << ia << ' ' << ia
        << "'/>";
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        const auto& hub = robot.rotors.positions_m[i];
        xml << "<site name='rotor" << i << "' pos='" << hub[0] << ' ' << hub[1] << ' ' << hub[2] << "'/>";
    }
    xml << "<body name='arm' pos='" << robot.arm.joint_x_m << " 0 " << robot.arm.joint_z_m << "'>"
        << "<joint name='arm' type='hinge' axis='0 1 0'/>"
        << "<inertial pos='" << robot.arm.center_of_mass_m << " 0 0' mass='"
        << robot.arm.mass_kg * (1 + world.arm_mass_scale) << "' diaginertia='" << ib << ' ' << ib << ' ' << ib
        << "'/></body></body></worldbody><actuator><motor joint='arm'/>";  // ones without a state first
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        const double gear = (1 + world.thrust_scale) * (1 + world.rotor_thrust_scale[i]);
        xml << "<general site='rotor" << i << "' gear='0 0 " << gear << " 0 0 0'";
        if (lag_s > 0) {
            xml << " dyntype='filter' dynprm='" << lag_s << "'";
        }
        xml << "/>";
    }
    xml << "</actuator></mujoco>";
    return xml.str();
}

/// The robot in a MuJoCo world of its own, integrated by RK4.
class MujocoWorld {
 public:
    /// @throws std::runtime_error with MuJoCo's words
    MujocoWorld(const Robot& robot, double step_s, const World& world = {}) {
        const std::string xml = mjcf(robot, step_s, world);
        const auto files = std::make_unique<mjVFS>();
        mj_defaultVFS(files.get());
        mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
        std::memcpy(files->filedata[0], xml.data(), xml.size());
        char error[1000] = "";
        model_.reset(mj_loadXML("robot.xml", files.get(), error, sizeof(error)));
        mj_deleteVFS(files.get());
        if (model_ == nullptr || model_->nv != 4) {
            throw std::runtime_error(std::string("no robot for MuJoCo: ") + error);
        }
        data_.reset(mj_makeData(model_.get()));
    }
    /// Holds a command from now on.
    void command(const dynamics::PlantCommand<double>& given, int rotors) {
        data_->ctrl[0] = given.joint_torque_nm;
        std::copy(given.thrust_n, given.thrust_n + rotors, data_->ctrl + 1);
    }
    [[nodiscard]] mjModel* model() const { return model_.get(); }
    mjData* data() { return data_.get(); }

 private:
    struct Free {
        void operator()(mjModel* model) const { mj_deleteModel(model); }
        void operator()(mjData* data) const { mj_deleteData(data); }
    };
    std::unique_ptr<mjModel, Free> model_;
    std::unique_ptr<mjData, Free> data_;
};

}  // namespace downwash::test
