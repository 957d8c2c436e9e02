#pragma once

#include <cmath>

#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/flight.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/noise.hpp"

// What planning and execution share: the loop over the ticks of a segment and the sources of surface effects.

namespace downwash::simulation {

/// The effect, evaluated directly.
struct DirectFactor {
    const FlightModel& model;
    /// K at the hub of a rotor, or of the body, in the plane.
    double operator()(int rotor, double x_m, double z_m) const { return model.direct_factor(rotor, x_m, z_m); }
    /// The same by side.
    [[nodiscard]] SidedFactor<double> sided(int rotor, double x_m, double z_m) const {
        return model.sided_factor(rotor, x_m, z_m);
    }
};

/// One tick of a vehicle in a world, without its noise and gusts; surface effects are the nominal ones.
/// @param factor,integrate see tick()   @param in nullptr: the nominal world
template <class Factor, class Integrate = dynamics::OneStep>
FlightState quiet_tick(const FlightModel& model, const FlightState& state, const ReferencePoint& reference,
                       Factor&& factor, controllers::Actuation<double>& given, const Integrate& integrate = {},
                       const FlownWorld* in = nullptr) {
    const FlownWorld* const world = flown_world(model, in);
    if (world == nullptr) {
        return tick(model.tick(), state, reference, factor, given, integrate);
    }
    const double no_noise[noise_count] = {};
    return controllers::visit_flown(model.tick().law, [&](const auto& law) {
        return tick_in_world(model.tick(), law, world->numbers, no_noise, state, reference, factor, given, integrate);
    });
}

/// Moves a vehicle along a segment until `after` finds a reason to end the flight.
/// @param step callable (tick of the segment, state, reference, given) -> state one tick later
/// @param after callable (before, reference, given, next, next_reference) -> Rejection
template <class Step, class After>
Rejection fly_steps(const ReferenceSegment& segment, FlightState& state, const Step& step, After&& after) {
    ReferencePoint reference = segment.from();
    Rejection rejection = Rejection::none;
    for (std::int64_t t = 0; t < segment.ticks() && rejection == Rejection::none; ++t) {
        controllers::Actuation<double> given{};
        const FlightState next = step(t, state, reference, given);
        const ReferencePoint next_reference = segment.at_tick(t + 1);
        rejection = after(state, reference, given, next, next_reference);
        state = next;
        reference = next_reference;
    }
    return rejection;
}

/// Flies a segment in a world, tick by tick.
/// @param effect see WorldSurroundings   @param after see fly_steps()
template <class Effect, class Integrate, class After>
Rejection fly_ticks(const TickModel& model, const FlownWorld& world, std::int64_t first_tick,
                    const ReferenceSegment& segment, Effect&& effect, const Integrate& integrate, FlightState& state,
                    After&& after) {
    return controllers::visit_flown(model.law, [&](const auto& law) {
        double noise[noise_count] = {};
        const auto step = [&](std::int64_t t, const FlightState& from, const ReferencePoint& reference,
                              controllers::Actuation<double>& given) {
            if (world.has_noise) {
                draw_noise(normal_levels(), world.world.tape, first_tick + t, noise, 1);
            }
            return tick_in_world(model, law, world.numbers, noise, from, reference, effect, given, integrate);
        };
        return fly_steps(segment, state, step, after);
    });
}

/// Flies a segment by the plain tick.
/// @param factor,integrate see tick()   @param after see fly_steps()
template <class Factor, class Integrate, class After>
Rejection fly_ticks(const TickModel& model, const ReferenceSegment& segment, Factor&& factor,
                    const Integrate& integrate, FlightState& state, After&& after) {
    return controllers::visit_flown(model.law, [&](const auto& law) {
        const auto step = [&](std::int64_t, const FlightState& from, const ReferencePoint& reference,
                              controllers::Actuation<double>& given) {
            const VehicleState<double>& vehicle = from;
            const auto motion = dynamics::motion_at(model.plant, vehicle.plant.q, vehicle.plant.u);
            return FlightState{tick(model, law, vehicle, motion, reference, factor, given, integrate), from.world};
        };
        return fly_steps(segment, state, step, after);
    });
}

}  // namespace downwash::simulation
