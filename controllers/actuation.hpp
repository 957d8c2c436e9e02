#pragma once

#include "downwash/dynamics/plant_state.hpp"

// What a control law demands, and what it commands. One template over the lane type; actuate.hpp makes one of the
// other.

namespace downwash::controllers {

/// What a control law asks for, before allocation and any limit.
template <class T>
struct Demand {
    T thrust_n;          ///< F3
    T pitch_torque_nm;   ///< T2
    T arm_acceleration;  ///< v7 [rad/s2]; the joint torque follows from it and from what the rotors really give
};

/// What a control law commands for one tick.
template <class T>
struct Actuation {
    dynamics::PlantCommand<T> command;  ///< held over the tick, within the limits
    T saturation;  ///< greatest demand over its limit: 1 at the limit, more when something had to be clipped; a rotor's
                   ///< lead does not count
};

// What a law without aids knows besides its model; actuate.hpp defines it.
struct Unaided;

}  // namespace downwash::controllers
