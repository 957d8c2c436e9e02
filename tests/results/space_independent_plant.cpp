#include "space_independent_plant.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "../dynamics/space_newton_euler.hpp"

namespace downwash::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// The forces along all speeds that accelerations need: force and torque in body axes, then joint torques.
VectorXd needed(const SpacePlant& plant, const SpaceVector& s, const Eigen::Matrix3d& axes, const VectorXd& du) {
    const SpaceForces forces = space_newton_euler_forces(plant, s.q.data(), s.u.data(), du.data());
    VectorXd all(du.size());
    all.head<3>() = axes.transpose() * forces.force_n;
    all.segment<3>(3) = axes.transpose() * forces.torque_nm;
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        all[static_cast<Eigen::Index>(6 + i)] = forces.joint_torques_nm[i];
    }
    return all;
}

SpaceVector rate(const SpaceRobot& robot, const SpaceRotorFactor& factor, const SpaceVector& s,
                 const HeldSpaceCommand& command) {
    const SpacePlant& plant = robot.plant;
    const bool lags = plant.time_constant_s > 0;
    const Eigen::Matrix3d axes = Eigen::Quaterniond(s.q[3], s.q[4], s.q[5], s.q[6]).normalized().toRotationMatrix();
    const auto size = static_cast<Eigen::Index>(s.u.size());
    SpaceVector d = s;
    d.energy_j = 0;
    VectorXd given = VectorXd::Zero(size);
    for (std::size_t i = 0; i < plant.rotors.size(); ++i) {
        const SpaceRotor& rotor = plant.rotors[i];
        const Vector3d at = vector_of(rotor.position_m);
        const Vector3d axis = vector_of(rotor.axis).normalized();
        const Vector3d hub = Vector3d(s.q[0], s.q[1], s.q[2]) + axes * at;
        const double sine = (axes * axis).head<2>().norm();
        const double thrust_n = lags ? s.lag_n[i] : command.rotor_n[i];
        const double acting_n = factor(i, {hub[0], hub[1], hub[2]}, sine) * thrust_n;
        given.head<3>() += acting_n * axis;
        given.segment<3>(3) += acting_n * at.cross(axis) - rotor.spin * rotor.drag_torque_m * thrust_n * axis;
        d.energy_j += plant.power_coefficient_w_n1p5 * std::pow(thrust_n, 1.5);
        d.lag_n[i] = lags ? (command.rotor_n[i] - thrust_n) / plant.time_constant_s : 0;
    }
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        given[static_cast<Eigen::Index>(6 + i)] = command.joint_torque_nm[i];
        d.energy_j += std::abs(command.joint_torque_nm[i] * s.u[6 + i]);
    }
    const VectorXd rest = needed(plant, s, axes, VectorXd::Zero(size));
    Eigen::MatrixXd mass(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        mass.col(i) = needed(plant, s, axes, VectorXd::Unit(size, i)) - rest;
    }
    const VectorXd du = mass.fullPivLu().solve(given - rest);
    d.u.assign(du.data(), du.data() + size);
    std::copy_n(s.u.begin(), 3, d.q.begin());
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(s.q[3], s.q[4], s.q[5], s.q[6]) * Eigen::Quaterniond(0, s.u[3], s.u[4], s.u[5]);
    const double turned[] = {turn.w(), turn.x(), turn.y(), turn.z()};
    for (std::size_t i = 0; i < 4; ++i) {
        d.q[3 + i] = 0.5 * turned[i];
    }
    std::copy(s.u.begin() + 6, s.u.end(), d.q.begin() + 7);
    return d;
}

SpaceVector moved(SpaceVector s, const SpaceVector& d, double dt_s) {
    const auto add = [dt_s](std::vector<double>& to, const std::vector<double>& by) {
        for (std::size_t i = 0; i < to.size(); ++i) {
            to[i] += dt_s * by[i];
        }
    };
    add(s.q, d.q);
    add(s.u, d.u);
    add(s.lag_n, d.lag_n);
    s.energy_j += dt_s * d.energy_j;
    return s;
}

}  // namespace

SpaceVector integrated(const SpaceRobot& robot, const SpaceRotorFactor& factor, SpaceVector state,
                       const HeldSpaceCommand& command, double duration_s, int steps) {
    const double h = duration_s / steps;
    for (int step = 0; step < steps; ++step) {
        const SpaceVector k1 = rate(robot, factor, state, command);
        const SpaceVector k2 = rate(robot, factor, moved(state, k1, h / 2), command);
        const SpaceVector k3 = rate(robot, factor, moved(state, k2, h / 2), command);
        const SpaceVector k4 = rate(robot, factor, moved(state, k3, h), command);
        state = moved(moved(moved(moved(state, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
        const double length = std::hypot(std::hypot(state.q[3], state.q[4]), std::hypot(state.q[5], state.q[6]));
        for (std::size_t i = 3; i < 7; ++i) {
            state.q[i] /= length;
        }
    }
    return state;
}

}  // namespace downwash::test
