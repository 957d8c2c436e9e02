#pragma once

#include <cstdint>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/simulation/contact_goal.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash {

/// How a touch ended.
struct TouchFlight {
    Rejection rejection = Rejection::none;  ///< `goal_missed` also where the force was not held
    TouchRecord record;
    std::int64_t ticks = 0;  ///< that it took, or until it ended early
};

/// Flies a touch in a world, from a hover in front of the surface to the same hover: the robot approaches, touches,
/// holds the force and leaves. A flight may touch the surface with the part that is meant to, and nothing else.
/// @param map surface effects; nullptr: there are none, and all is flyable
/// @param base reference of the hover, at rest   @param state vehicle there; replaced by that at the end
[[nodiscard]] DOWNWASH_EXPORT TouchFlight fly_touch(const FlightModel& model, const AeroMap* map, const Touch& touch,
                                                    const ReferencePoint& base, FlightState& state,
                                                    const FlightWorld& in = {});

}  // namespace downwash
