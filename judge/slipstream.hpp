#pragma once

#include <array>

#include "downwash/judge/equations_of_motion.hpp"

// The slipstreams of the rotors on the arm (docs/model.md 2.7), in world axes and with a fine sum along the arm: not
// the plant's formulas. Private: not installed.

namespace downwash::judge {

/// Speed of the air in a slipstream, along the rotor's axis, over that of momentum theory at the disc.
/// @param depth_m below the disc   @param away_m from the axis
[[nodiscard]] DOWNWASH_EXPORT double slipstream_ratio(double radius_m, double depth_m, double away_m);

/// Adds what the slipstreams change of the arm's drag.
/// @param thrust_n of each rotor in free air, as it really acts
DOWNWASH_EXPORT void add_wash(const Vehicle& vehicle, const Motion& motion,
                              const std::array<double, max_rotors>& thrust_n, Planar wind_m_s, Loads& loads);

}  // namespace downwash::judge
