#pragma once

#include <Eigen/Dense>
#include <vector>

#include "downwash/dynamics/space_plant.hpp"

namespace downwash::test {

/// What makes a plant in space move as it does.
struct SpaceForces {
    Eigen::Vector3d force_n;    ///< on the multirotor, world axes
    Eigen::Vector3d torque_nm;  ///< about its centre of mass, world axes
    std::vector<double> joint_torques_nm;
};

/// The forces behind accelerations, by the recursive Newton-Euler algorithm in world axes (thesis A.7 to A.9).
/// @param q,u,du as in space_body.hpp
[[nodiscard]] SpaceForces space_newton_euler_forces(const SpacePlant& plant, const double* q, const double* u,
                                                    const double* du);

}  // namespace downwash::test
