#pragma once

// Which solids of a robot in space can touch each other. Private: not installed.

#include <cstdint>
#include <vector>

#include "downwash/scene/space_frames.hpp"

namespace downwash {

/// Two solids of a robot, by their numbers; the second is farther out on the arm.
struct SelfPair {
    std::uint32_t first, second;
};

/// The pairs of solids of a robot that have to be compared. Never those of one body or of neighbours: of a link and
/// what it is mounted on, where links without a solid count as part of what they are mounted on. Nor those that touch
/// at each of 256 sets of joint angles, spread evenly within the limits: they overlap by design.
struct SelfPairs {
    std::vector<SelfPair>
        within_limits;  ///< those that may touch while no joint is beyond its limits by more than joint_swing_rad
    std::vector<SelfPair> beyond_limits;  ///< all
};

/// Decides once. A pair is left out within limits if it is proven to stay apart: joint angles are halved until the
/// distance in the middle of each piece is greater than how far the solids can move against each other in it. Where no
/// proof is found with 2000 distances, the pair is kept.
[[nodiscard]] SelfPairs self_pairs(const SpaceArm& arm, const std::vector<RobotPiece>& pieces, const SpaceReach& reach);

}  // namespace downwash
