#pragma once

#include <vector>

namespace downwash {

/// What a vehicle in flight carries besides its motion.
struct SpaceCarry {
    /// Free-air thrust that the rotors' lag has reached [N], of each rotor; empty: they carry the weight.
    std::vector<double> rotor_thrust_n;
    /// Numbers of the control law's memory, in the order of its Memory; empty: that of a law that has come to rest.
    std::vector<double> controller_memory;
};

}  // namespace downwash
