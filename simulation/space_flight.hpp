#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/simulation/space_flight_record.hpp"

namespace downwash {

/// Flies a plan from its first knot to its last and holds there. Where a plan hovers for a contact, the vehicle touches
/// after that hover, with the part that is meant to and nothing else, and the plan then goes on. The flight ends early
/// where
/// - the vehicle is unstable: its numbers are not finite, it is more than unstable_error_m from its reference, or it
///   tilts by more than unstable_pitch_rad although it has been upright. A vehicle that starts tilted may recover;
/// - the robot touches an obstacle or itself, at a tick or between two of them;
/// - a rotor leaves the flyable area;
/// - a touch is not met.
/// @param start vehicle at the first knot
/// @throws InputError if the robot has more joints than this library was built for; WorkStopped when `is_over` says so
/// @pre space_robot_errors(robot) is empty, the plan has at least one knot, the robot's number of joints and its tick
[[nodiscard]] DOWNWASH_EXPORT SpaceFlight fly(const SpaceRobot& robot, const SpacePlan& plan, const SpaceMotion& start,
                                              const SpaceFlightSettings& settings = {});

/// How a touch was flown.
struct SpaceTouchFlown {
    Rejection rejection = Rejection::none;  ///< goal_missed where the touch is not met, or the hover after it
    std::int64_t ticks = 0;
};

/// Flies the touch that follows a hover as fly() does, with a vehicle that comes from another flight.
/// @param rule of the hover's goal   @param hover with a touch   @param at reference of the hover
/// @param[in,out] vehicle at the end of the hover; then at the end of the touch
/// @param settings without a plan: settles, hold_ticks, goals, further goal and budget do not count
/// @throws as fly()   @pre the robot is that of the vehicle, the world that of its flight
[[nodiscard]] DOWNWASH_EXPORT SpaceTouchFlown fly_touch(const SpaceRobot& robot, const SpaceGoalRule& rule,
                                                        const SpaceGoalHover& hover, const SpacePoint& at,
                                                        AnySpaceState& vehicle, const SpaceFlightSettings& settings);

}  // namespace downwash
