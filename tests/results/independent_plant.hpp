#pragma once

#include <functional>
#include <vector>

#include "downwash/simulation/robot.hpp"

namespace downwash::test {

/// x, z, pitch, arm, their rates, energy, and the thrust that each rotor's lag has reached (without lag unused).
using PlantVector = std::vector<double>;

/// Commands held over a tick.
struct HeldCommand {
    std::vector<double> rotor_n;
    double arm_torque_nm = 0;
};

/// Surface effect at a rotor hub: (rotor, x_m, z_m) -> K.
using RotorFactor = std::function<double(std::size_t, double, double, double)>;

/// The plant as docs write it down, mass matrix and all, and nothing of dynamics/: the state after some time.
[[nodiscard]] PlantVector integrated(const Robot& robot, const RotorFactor& factor, PlantVector state,
                                     const HeldCommand& command, double duration_s, int steps);

}  // namespace downwash::test
