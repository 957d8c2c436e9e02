#pragma once

#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_loop.hpp"

namespace downwash::test {

/// One plain tick among surfaces. @tparam Field a simulation::EffectField
template <class Field = simulation::NoEffect>
FlightState single_tick(const simulation::TickModel& model, const FlightState& state, const ReferencePoint& reference,
                        controllers::Actuation<double>& given, const Field& field = {}) {
    simulation::FlightEffectOf effect{field};
    return simulation::FlightLoop(model, nullptr, effect).tick(0, state, reference, given);
}

/// One tick of the nominal world, or of another, without noise; surface effects are evaluated directly.
inline FlightState single_quiet_tick(const FlightModel& model, const FlightState& state,
                                     const ReferencePoint& reference, controllers::Actuation<double>& given,
                                     const FlownWorld* world = nullptr) {
    simulation::FlightEffectOf effect{simulation::DirectField(model)};
    return simulation::FlightLoop(model.tick(), flown_world(model, world), effect).quiet_tick(state, reference, given);
}

}  // namespace downwash::test
