#pragma once

#include <functional>
#include <vector>

#include "downwash/simulation/space_robot.hpp"

namespace downwash::test {

/// A vehicle in space: q and u as in docs/model.md 2.2, energy, and the thrust that each rotor's lag has reached.
struct SpaceVector {
    std::vector<double> q, u;
    double energy_j = 0;
    std::vector<double> lag_n;  ///< of each rotor; unused without lag
};

/// Commands held over a tick.
struct HeldSpaceCommand {
    std::vector<double> rotor_n, joint_torque_nm;
};

/// Surface effect on a tilted rotor: (rotor, place of its hub, sine of its tilt) -> K.
using SpaceRotorFactor = std::function<double(std::size_t, const Vector3&, double)>;

/// The plant as docs write it down, without drag, friction and rotor inertia, and with nothing of dynamics/: a mass
/// matrix from the inverse dynamics of the recursive Newton-Euler algorithm, classical Runge-Kutta steps.
[[nodiscard]] SpaceVector integrated(const SpaceRobot& robot, const SpaceRotorFactor& factor, SpaceVector state,
                                     const HeldSpaceCommand& command, double duration_s, int steps);

}  // namespace downwash::test
