#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "downwash/controllers/actuation.hpp"
#include "downwash/dynamics/planar_contact.hpp"
#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/flight_rules.hpp"

// A touch, tick by tick (docs/model.md 7.5). Private: not installed.

namespace downwash::simulation {

/// The pose at which to check the obstacles that are not touched: moved out of the surface, and a little farther.
[[nodiscard]] inline PlanarPose off_surface(PlanarPose pose, const Touch& touch, double depth_m) {
    constexpr double air_m = 5e-4;
    const double back_m = std::max(0.0, depth_m + air_m);
    pose.x_m += back_m * touch.normal.x;
    pose.z_m += back_m * touch.normal.z;
    return pose;
}

/// AfterTick with what happened at the surface over the tick.
using AfterTouchTick = std::function<Rejection(
    const FlightState& before, const ReferencePoint& reference, const controllers::Actuation<double>& given,
    const FlightState& next, const ReferencePoint& next_reference, const dynamics::ContactTickRecord& contact)>;

/// Flies a touch, from a hover in front of the surface to the same hover.
/// @param world nullptr: the plain tick   @param first_tick of the whole flight
/// @param base reference of that hover; what calls may change its own meanwhile   @param state vehicle there; replaced
/// by that at the end
Rejection fly_touch_ticks(const FlightModel& model, const FlownWorld* world, std::int64_t first_tick,
                          const Touch& touch, ReferencePoint base, FlightEffect& effect, FlightState& state,
                          TouchRecord& record, const AfterTouchTick& after);

}  // namespace downwash::simulation
