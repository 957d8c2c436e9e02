#pragma once

#include <cmath>

#include "downwash/simulation/flight.hpp"
#include "downwash/simulation/map_effect.hpp"

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
                const FlightState next = tick(model, law, state, motion, reference, factor, given, integrate);
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
