#pragma once

#include "downwash/effects/surface_effect.hpp"
#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// Two rotors of a vehicle under a wide ceiling, one in front and one behind its centre.
struct RotorPair {
    double arm_m = 0.25;       ///< from the centre to each hub
    double radius_m = 0.1194;  ///< radius of the rotor in the thesis' fit (2.18), 9.4 inches
};

/// How much more the front rotor's K is than the rear one's: K_front / K_rear - 1, with the vehicle's pitch raising the
/// front hub by arm sin(pitch). The discs count as level (thesis 4.6). Infinite if a hub would touch the ceiling.
/// @param distance_m from the plane through both hubs of a level vehicle to the ceiling, at the centre
[[nodiscard]] DOWNWASH_EXPORT double difference_between_rotors(const SurfaceEffect& ceiling, const RotorPair& pair,
                                                               double pitch_rad, double distance_m);

/// The least distance at which that difference is at most `most`, by bisection to 1e-6 m.
[[nodiscard]] DOWNWASH_EXPORT double least_distance_m(const SurfaceEffect& ceiling, const RotorPair& pair,
                                                      double pitch_rad, double most);

/// Which pitch a vehicle under a ceiling may have (thesis 4.6 and figure 4.9).
[[nodiscard]] DOWNWASH_EXPORT Study ceiling_envelope();

}  // namespace downwash::studies
