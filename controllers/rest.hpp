#pragma once

#include <cstdint>

#include "downwash/dynamics/plant_state.hpp"

// A vehicle at rest in closed loop: what its control law has to remember and to be given to hold it there.

namespace downwash {

/// What stands in the way of an equilibrium.
enum class HoldLimit : std::uint8_t {
    none,
    arm_angle,     ///< beyond the limits of the arm
    rotor_thrust,  ///< a rotor would have to give more than its greatest or less than its least thrust
    joint_torque,  ///< the joint is too weak to carry the arm
    tilt,          ///< countering the surfaces' torque takes a pitch reference beyond max_tilt
    vertical,      ///< the vertical force would fall below the controller's least (min_vertical_force_ratio)
    gain,          ///< a loop without gain cannot ask for what is needed
};

namespace controllers {

/// The commands that balance a level vehicle at rest.
struct RestingCommand {
    /// Wrench that acts by what the law knows: with a feed-forward not that in free air.
    dynamics::RotorWrench<double> wrench;
    double joint_torque_nm;
    double known_force[4] = {};  ///< what else acts by what the law knows [N, N, N m, N m]: see Unaided::force()
};

/// The equilibrium of a control law: what it remembers and is given when it asks for these commands for ever.
template <template <class> class Memory>
struct Rest {
    HoldLimit limit = HoldLimit::none;  ///< why the law cannot; then the rest of this is of no use
    Memory<double> memory{};
    Memory<bool> feeds_back{};       ///< whether the next ticks depend on that number of the memory
    double error[3] = {};            ///< where the reference has to be, from the vehicle: x, z [m], arm [rad]
    double pitch_reference_rad = 0;  ///< pitch that the law asks for in vain, to counter the surfaces' torque
    double height_gain_1_s2 = 0;     ///< vertical acceleration per metre of error
    double pitch_gain_1_s2 = 0;      ///< pitch acceleration per radian of error
};

}  // namespace controllers
}  // namespace downwash
