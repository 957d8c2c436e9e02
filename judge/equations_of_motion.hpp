#pragma once

#include "downwash/base/export.hpp"
#include "downwash/judge/vehicle.hpp"

// Newton's and Euler's equations of the two bodies, each with its own coordinates, joined by the force in the joint:
// not the generalised coordinates of docs/model.md 2, and the same motion. Private: not installed.

namespace downwash::judge {

/// Where the vehicle is and how it moves: the true centre of mass of the multirotor, pitch and arm angle.
struct Motion {
    Planar position_m, velocity_m_s;
    double pitch_rad = 0, pitch_rate_rad_s = 0;
    double arm_rad = 0, arm_rate_rad_s = 0;  ///< relative to the multirotor
};

/// What acts on the bodies apart from gravity and the joint.
struct Loads {
    Planar body_force_n;         ///< force at the centre of mass of the multirotor
    double body_moment_nm = 0;   ///< about it
    Planar arm_force_n;          ///< force at the centre of mass of the arm
    double arm_moment_nm = 0;    ///< about it
    double joint_torque_nm = 0;  ///< on the arm; the multirotor gets the opposite
};

/// How the motion changes.
struct Acceleration {
    Planar position_m_s2;
    double pitch_rad_s2 = 0, arm_rad_s2 = 0;
};

/// Solves for the accelerations of both bodies and the force in the joint: six equations of motion, and the two that
/// say that both bodies agree about the acceleration of the joint.
[[nodiscard]] DOWNWASH_EXPORT Acceleration acceleration_of(const Vehicle& vehicle, const Motion& motion,
                                                           const Loads& loads);

/// Adds the drag of both bodies in air that moves with `wind_m_s` (docs/model.md 2.1). The force along the arm is a
/// polynomial in the distance from the joint wherever the stream crosses it from one side, and is integrated so.
DOWNWASH_EXPORT void add_drag(const Vehicle& vehicle, const Motion& motion, Planar wind_m_s, Loads& loads);

/// Kinetic and potential energy of both bodies [J], the latter over z = 0.
[[nodiscard]] DOWNWASH_EXPORT double mechanical_energy_j(const Vehicle& vehicle, const Motion& motion);

}  // namespace downwash::judge
