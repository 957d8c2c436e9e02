#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/dynamics/space_plant.hpp"

// The slipstreams that may meet the links of an arm in space, as plain numbers for the tick: docs/model.md 2.9.
// link_wash.hpp has the arithmetic.

namespace downwash {

/// Slipstreams of the rotors. Two rotors that mirror each other in the plane y = 0 of the body blow as one with the
/// momentum of both.
struct SpaceSlipstreams {
    int count = 0;                ///< 0: none meets a link, or the robot has no wash
    int rotor[max_rotors] = {};   ///< a rotor of each
    int mirror[max_rotors] = {};  ///< the rotor that mirrors it, or -1
    /// Two unit vectors across the axis of each rotor of the plant, and across each other.
    dynamics::LaneVector<double> first_across[max_rotors] = {}, second_across[max_rotors] = {};
    double radius_m = 0;             ///< radius of the rotors
    double speed_squared_per_n = 0;  ///< square of the air's speed at the disc over the thrust [m2/s2/N]
};

inline constexpr SpaceSlipstreams no_space_slipstreams;

/// The slipstreams of a plant. @param rotor_radius_m radius of all its rotors, > 0
[[nodiscard]] DOWNWASH_EXPORT SpaceSlipstreams space_slipstreams_of(const SpacePlant& plant, double rotor_radius_m);

}  // namespace downwash
