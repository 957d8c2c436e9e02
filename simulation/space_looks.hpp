#pragma once

#include "downwash/scene/collision_checker_kind.hpp"

// How far a flight goes on until it looks for collisions again. Private: not installed.

namespace downwash::simulation {

/// A free motion is looked for up to this [m]. A larger one lets the robot fly farther before the next check; a smaller
/// one is found faster.
inline constexpr double max_free_motion_m = 0.5;

/// How much free motion is left aside: distances are exact to 1e-8 m by our own geometry, good to a millimetre by FCL.
[[nodiscard]] inline double free_motion_error_m(CollisionCheckerKind kind) noexcept {
    return kind == CollisionCheckerKind::own ? 1e-7 : 0.002;
}

}  // namespace downwash::simulation
