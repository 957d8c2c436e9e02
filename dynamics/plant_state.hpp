#pragma once

#include "downwash/dynamics/plant.hpp"

// What the plant's tick reads and writes, one template over the lane type. Nothing is computed here: flight_step.hpp
// moves the plant.

namespace downwash::dynamics {

/// The state of the plant.
template <class T>
struct PlantState {
    T q[4];                  ///< x, z [m], pitch, arm [rad]
    T u[4];                  ///< their time derivatives
    T thrust_n[max_rotors];  ///< free-air thrust of each rotor; follows the command with the rotors' lag, if any
    T energy_j;              ///< rotor and arm energy spent so far
};

/// The commands, constant over one tick.
template <class T>
struct PlantCommand {
    T thrust_n[max_rotors];  ///< free-air thrust of each rotor, within its limits
    T joint_torque_nm;
};

/// A point of the plane [m], or another vector in it.
template <class T>
struct PlanePoint {
    T x, z;
};

/// Total thrust along b3 [N] and pitch torque [N m] of rotors in aerodynamic effect (thesis figure C.3), and the
/// horizontal force along x [N] by which walls push.
template <class T>
struct RotorWrench {
    T thrust_n;
    T pitch_torque_nm;
    T wall_push_n = T(0);
};

// For headers that only hand them on; rigid_body.hpp defines them.
template <class T>
struct Attitude;
template <class T>
struct Motion;
template <class T>
struct EquationsOfMotion;

}  // namespace downwash::dynamics
