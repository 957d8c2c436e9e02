#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/simulation/flight_rules.hpp"

// When a vehicle in space is lost, from nothing but the numbers of one tick. One template over the lane type;
// rule_checks.hpp has the rules of the plane.

namespace downwash::simulation {

/// Distance of a vehicle from its reference [m].
/// @param position_m,reference three numbers each
template <class T>
T space_tracking_error_m(const T* position_m, const T* reference) {
    const T dx = reference[0] - position_m[0];
    const T dy = reference[1] - position_m[1];
    const T dz = reference[2] - position_m[2];
    return lane::sqrt(dx * dx + dy * dy + dz * dz);
}

/// Cosine of the angle between the body's z axis and the vertical. A vehicle that was within unstable_pitch_rad and no
/// longer is has fallen over. One that starts tilted may recover.
/// @param q its attitude as a quaternion (w, x, y, z) of any length but zero
template <class T>
T cosine_of_tilt(const T* q) {
    return T(1) - T(2) * (q[1] * q[1] + q[2] * q[2]) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

/// How fast a vehicle rolls and pitches together [rad/s]. @param u its speeds, body rates from the fourth on
template <class T>
T tilt_rate_rad_s(const T* u) {
    return lane::sqrt(u[3] * u[3] + u[4] * u[4]);
}

}  // namespace downwash::simulation
