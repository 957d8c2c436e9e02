#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant.hpp"

// The slipstreams that may meet the arm, as plain numbers for the tick: docs/model.md 2.7. arm_wash.hpp has the
// arithmetic.

namespace downwash {

/// Slipstreams of rotors beside or over the plane in which the arm turns. Two rotors that mirror each other in this
/// plane have one between them, with the momentum of both.
struct Slipstreams {
    int count = 0;                  ///< 0: none meets the arm, or the robot has no wash
    int rotor[max_rotors] = {};     ///< a rotor of each
    int of_rotor[max_rotors] = {};  ///< number of each rotor's slipstream; `count` for a rotor that never meets the arm
    double lateral_m[max_rotors] = {};  ///< distance of each from the arm's plane, >= 0
    double radius_m = 0;                ///< radius of the rotors
    double speed_squared_per_n = 0;     ///< square of the air's speed at the disc over the thrust [m2/s2/N]
};

inline constexpr Slipstreams no_slipstreams;

/// The slipstreams of a robot. All rotors have the same radius; the arm turns in the plane y = 0 of the body frame.
[[nodiscard]] DOWNWASH_EXPORT Slipstreams slipstreams_of(const ArmParameters& arm, const RotorParameters& rotors);

}  // namespace downwash
