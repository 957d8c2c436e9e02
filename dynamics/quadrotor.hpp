#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/dynamics/space_plant.hpp"

// The conventional quadrotor of thesis chapter 4.

namespace downwash {

/// Where the arms of a quadrotor point.
enum class QuadrotorLayout : std::uint8_t {
    plus,   ///< forward, left, back and right
    cross,  ///< half-way between: the layout of the thesis
};

/// A quadrotor whose axes of inertia are those of its body frame, with four rotors that push straight up.
struct QuadrotorParameters {
    double mass_kg = 0;                   ///< m, > 0
    Vector3 inertia_kg_m2 = {};           ///< Ix, Iy, Iz, each > 0
    double arm_m = 0;                     ///< d, from the centre to each rotor's axis (thesis (4.10)), > 0
    double rotor_height_m = 0;            ///< height of the hubs over the centre of mass
    double drag_torque_m = 0;             ///< c_D / c_T: yaw torque per newton of thrust (thesis (4.13)), >= 0
    double thrust_coefficient_n_s2 = 0;   ///< c_T, > 0 if there is a rotor inertia
    double rotor_inertia_kg_m2 = 0;       ///< Jr (thesis (4.9)); 0: no gyroscopic term
    double time_constant_s = 0;           ///< time constant of the first-order thrust lag; 0: none
    double power_coefficient_w_n1p5 = 0;  ///< >= 0
    QuadrotorLayout layout = QuadrotorLayout::cross;
};

/// The quadrotor as a plant in space without an arm. Its rotors have the numbers of thesis (4.13): in the cross layout
/// 1 stands back right, 2 front left, 3 back left, 4 front right; the plus layout is the same turned by 45 degrees
/// clockwise, so that 1 stands back, 2 front, 3 left, 4 right. Rotors 1 and 2 push the vehicle to positive yaw, so they
/// spin clockwise as seen from above; 3 and 4 spin the other way.
[[nodiscard]] DOWNWASH_EXPORT SpacePlant make_quadrotor(const QuadrotorParameters& quadrotor);

}  // namespace downwash
