#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"

namespace downwash {

/// Where a vehicle in space looks, where no goal asks for a yaw.
enum class YawMode : std::uint8_t {
    free,    ///< turns to the next yaw that a goal asks for, the shorter way; stays there after the last one
    hold,    ///< stays as it is
    along,   ///< looks where it flies
    toward,  ///< looks at a point
};

/// A mode and what it needs.
struct YawRule {
    YawMode mode = YawMode::free;
    std::array<double, 2> target_m{};  ///< x and y of the point to look at; for `toward` only
};

/// Fills the yaw axis of knots. The first knot, where the vehicle is, keeps its yaw and how it turns. A knot whose yaw
/// a goal asks for takes it, and rests there in yaw. The others follow the rule:
/// - `free`: on one quintic from the last such knot before to the next one after.
/// - `hold`: the yaw of the knot before, at rest.
/// - `along`: the direction of the horizontal velocity, turning as this does; its acceleration, which would need the
///   jerk, counts as zero. Slower than 1 mm/s: the direction from the knot before, at rest.
/// - `toward`: the direction to the target, with its first and second derivative.
/// Where a direction is missing (less than 1 mm apart), the yaw is that of the knot before, at rest. Every yaw is the
/// one nearest to that of the knot before: the vehicle takes the shorter way, and yaw is unwrapped. Half a turn goes
/// left. Between knots the yaw is a quintic as any other axis: divide a plan to look along it, or at a point, more
/// closely.
/// @param knots ticks rising   @param tick_s length of a tick [s], > 0
/// @param asked the yaw that goals ask of each knot [rad], in any turn; one for each knot, or empty for none
[[nodiscard]] DOWNWASH_EXPORT std::vector<SpaceKnot> with_yaw(std::vector<SpaceKnot> knots, double tick_s,
                                                              const YawRule& rule,
                                                              std::span<const std::optional<double>> asked = {});

}  // namespace downwash
