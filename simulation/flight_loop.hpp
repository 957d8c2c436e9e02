#pragma once

#include <cmath>

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
};

/// Integrand of the objective `clearance` [1/m].
inline double clearance_density(double clearance_m) noexcept {
    return 1 / ((clearance_m > 0 ? clearance_m : 0) + 0.1);
}

/// Whether a property holds at the hub of every rotor, given as (rotor, x_m, z_m) in the plane.
template <class Predicate>
bool all_rotors(const FlightModel& model, const PlanarPose& pose, const Predicate& predicate) {
    const PlantModel& plant = model.tick().plant;
    const auto attitude = dynamics::attitude(plant, pose.pitch_rad, pose.arm_rad);
    for (int i = 0; i < plant.rotor_count; ++i) {
        const auto hub = dynamics::rotor_position(plant, attitude, pose.x_m, pose.z_m, i);
        if (!predicate(i, hub.x, hub.z)) {
            return false;
        }
    }
    return true;
}

/// Whether every rotor of a vehicle at this pose is inside the flyable area of a map.
inline bool is_flyable(const FlightModel& model, const AeroMap& map, const PlanarPose& pose) {
    return all_rotors(model, pose, [&](int rotor, double x_m, double z_m) {
        return map.is_flyable(model.rotor_layer(rotor), x_m, z_m);
    });
}

/// One tick of a vehicle in the nominal world, whether or not its controller sees late.
/// @param factor,integrate see tick()
template <class Factor, class Integrate = dynamics::OneStep>
FlightState nominal_tick(const FlightModel& model, const FlightState& state, const ReferencePoint& reference,
                         Factor&& factor, controllers::Actuation<double>& given, const Integrate& integrate = {}) {
    if (model.flies_plainly()) {
        return tick(model.tick(), state, reference, factor, given, integrate);
    }
    const double no_noise[noise_count] = {};
    NoEffect ceiling;
    return std::visit(
        [&](const auto& law) {
            return tick_in_world(model.tick(), law, model.nominal_world().numbers, no_noise, state, reference, factor,
                                 ceiling, given, integrate);
        },
        model.tick().law);
}

/// Flies a segment in a world, tick by tick, until `after` finds a reason to end the flight.
/// @param ceiling see WorldSurroundings   @param others as for fly_ticks() without a world
template <class Factor, class Ceiling, class Integrate, class After>
Rejection fly_ticks(const TickModel& model, const FlownWorld& world, std::int64_t first_tick,
                    const ReferenceSegment& segment, Factor&& factor, Ceiling&& ceiling, const Integrate& integrate,
                    FlightState& state, After&& after) {
    return std::visit(
        [&](const auto& law) {
            ReferencePoint reference = segment.from();
            Rejection rejection = Rejection::none;
            double noise[noise_count] = {};
            for (std::int64_t t = 0; t < segment.ticks() && rejection == Rejection::none; ++t) {
                if (world.has_noise) {
                    draw_noise(normal_levels(), world.world.tape, first_tick + t, noise, 1);
                }
                controllers::Actuation<double> given{};
                const FlightState next = tick_in_world(model, law, world.numbers, noise, state, reference, factor,
                                                       ceiling, given, integrate);
                const ReferencePoint next_reference = segment.at_tick(t + 1);
                rejection = after(state, reference, given, next, next_reference);
                state = next;
                reference = next_reference;
            }
            return rejection;
        },
        model.law);
}

/// Flies a segment tick by tick until `after` finds a reason to end the flight.
/// @param factor,integrate see tick()
/// @param after callable (before, reference, given, next, next_reference) -> Rejection
template <class Factor, class Integrate, class After>
Rejection fly_ticks(const TickModel& model, const ReferenceSegment& segment, Factor&& factor,
                    const Integrate& integrate, FlightState& state, After&& after) {
    return std::visit(
        [&](const auto& law) {
            ReferencePoint reference = segment.from();
            Rejection rejection = Rejection::none;
            for (std::int64_t t = 0; t < segment.ticks() && rejection == Rejection::none; ++t) {
                controllers::Actuation<double> given{};
                const auto motion = dynamics::motion_at(model.plant, state.plant.q, state.plant.u);
                const VehicleState<double>& vehicle = state;
                const FlightState next{tick(model, law, vehicle, motion, reference, factor, given, integrate),
                                       state.world};
                const ReferencePoint next_reference = segment.at_tick(t + 1);
                rejection = after(state, reference, given, next, next_reference);
                state = next;
                reference = next_reference;
            }
            return rejection;
        },
        model.law);
}

}  // namespace downwash::simulation
