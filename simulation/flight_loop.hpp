#pragma once

#include <cstdint>
#include <functional>
#include <variant>

#include "downwash/base/export.hpp"
#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/dynamics/integration.hpp"
#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/tick_model.hpp"
#include "downwash/simulation/vehicle_state.hpp"
#include "downwash/simulation/world.hpp"

// One vehicle in closed loop. Law, effects, world and integration are chosen at run time, so that the tick is compiled
// once for all that flies one vehicle at a time. Every number is that of the batched kernels to the last bit.

namespace downwash::simulation {

/// How the plant moves over a tick.
using Integration =
    std::variant<dynamics::OneStep, dynamics::RefinedStep, dynamics::ContactStep, dynamics::DisturbedStep>;

/// What a tick led to, and what the controller commanded in it. Called after every tick; anything but Rejection::none
/// ends the flight.
using AfterTick = std::function<Rejection(const FlightState& before, const ReferencePoint& reference,
                                          const controllers::Actuation<double>& given, const FlightState& next,
                                          const ReferencePoint& next_reference)>;

/// A vehicle in closed loop among surfaces, in a world.
class DOWNWASH_EXPORT FlightLoop {
 public:
    /// @param world nullptr: the plain tick   @pre all of them outlive the loop
    FlightLoop(const TickModel& model, const FlownWorld* world, FlightEffect& effect)
        : model_(model), world_(world), effect_(effect) {}

    /// The vehicle one tick later.
    /// @param number of the tick, from the start of the whole flight, for the noise of the world
    /// @param[out] given what the controller commanded
    [[nodiscard]] FlightState tick(std::int64_t number, const FlightState& state, const ReferencePoint& reference,
                                   controllers::Actuation<double>& given, const Integration& integration = {}) const;

    /// The vehicle one tick later, without the noise and gusts of the world.
    [[nodiscard]] FlightState quiet_tick(const FlightState& state, const ReferencePoint& reference,
                                         controllers::Actuation<double>& given,
                                         const Integration& integration = {}) const;

    /// Flies a segment tick by tick until `after` finds a reason to end the flight.
    /// @param first_tick of the segment, from the start of the whole flight
    /// @param state vehicle at its beginning, replaced by the vehicle at the end
    Rejection fly(std::int64_t first_tick, const ReferenceSegment& segment, FlightState& state, const AfterTick& after,
                  const Integration& integration = {}) const;

 private:
    /// @param[out] next not the state itself; a state of the same flight is replaced without an allocation
    void tick_with(const double* noise, const FlightState& state, const ReferencePoint& reference,
                   controllers::Actuation<double>& given, const Integration& integration, FlightState& next) const;
    void noisy_tick(std::int64_t number, const FlightState& state, const ReferencePoint& reference,
                    controllers::Actuation<double>& given, const Integration& integration, FlightState& next) const;

    const TickModel& model_;
    const FlownWorld* world_;
    FlightEffect& effect_;
};

}  // namespace downwash::simulation
