#pragma once

#include <array>
#include <string>
#include <vector>

#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/simulation/space_loop.hpp"

namespace downwash {

/// What a vehicle in space recorded at one moment.
struct LoggedTick {
    double t_s = 0;
    /// What its controller saw of the vehicle: late, biased and noisy, as sensors and estimator had it.
    SpaceMotion seen;
    SpacePoint reference;                              ///< only its positions count
    std::array<double, max_rotors> rotor_command_n{};  ///< free-air thrust, held until the next tick
    std::array<double, max_joints> joint_torque_nm{};  ///< of the arm's motors, held until the next tick
};

/// A recorded flight in space.
struct LoggedFlight {
    std::string name;  ///< for people
    /// Whether `seen` is how the vehicle truly moved, as in a trajectory.csv of ours, and not what it saw.
    bool is_true_motion = false;
    bool has_reference = false;
    std::vector<LoggedTick> ticks;  ///< times rise
};

}  // namespace downwash
