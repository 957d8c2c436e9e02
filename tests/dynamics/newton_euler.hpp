#pragma once

#include <array>

#include "downwash/dynamics/plant.hpp"

namespace downwash::test {

/// Four numbers, one per coordinate (x, z, pitch, arm).
using Four = std::array<double, 4>;

/// The generalised forces [N, N, N m, N m] that produce the accelerations du [m/s2, rad/s2] of the aerial manipulator,
/// by the recursive Newton-Euler algorithm in space (thesis A.7 to A.9): velocities and accelerations of the bodies
/// outward from the world, forces and moments inward again. Shares nothing with the closed form but its parameters.
[[nodiscard]] Four newton_euler_forces(const MultirotorParameters& multirotor, const ArmParameters& arm, const Four& q,
                                       const Four& u, const Four& du);

}  // namespace downwash::test
