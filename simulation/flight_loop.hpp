#pragma once

#include <cmath>

#include "downwash/simulation/flight.hpp"

// What planning and execution share of flying a segment: the loop over ticks and the sources of surface effect.

namespace downwash::simulation {

/// No surface effect anywhere.
struct NoEffect {
    double operator()(int, double, double) const noexcept { return 1; }
};

/// The effect looked up in a map.
struct MapEffect {
    const FlightModel& model;
    const AeroMap& map;
    double operator()(int rotor, double x_m, double z_m) const noexcept {
        return map.factor(model.rotor_layer(rotor), x_m, z_m);
    }
};

/// The effect evaluated exactly.
struct DirectFactor {
    const FlightModel& model;
    double operator()(int rotor, double x_m, double z_m) const { return model.direct_factor(rotor, x_m, z_m); }
};

inline controllers::Setpoint<double> setpoint(const ReferencePoint& point) noexcept {
    controllers::Setpoint<double> s;
    for (int i = 0; i < 3; ++i) {
        s.position[i] = point.position[i];
        s.velocity[i] = point.velocity[i];
        s.acceleration[i] = point.acceleration[i];
    }
    return s;
}

/// Path length of one step in the metric of the objective `length` [m].
inline double step_length_m(const FlightModel& model, const FlightState& from, const FlightState& to) noexcept {
    const double dx = to.plant.q[0] - from.plant.q[0];
    const double dz = to.plant.q[1] - from.plant.q[1];
    const double da = 0.5 * model.tick().plant.arm_length_m * (to.plant.q[3] - from.plant.q[3]);
    return std::sqrt(dx * dx + dz * dz + da * da);
}

/// Integrand of the objective `clearance` [1/m].
inline double clearance_density(double clearance_m) noexcept {
    return 1 / ((clearance_m > 0 ? clearance_m : 0) + 0.1);
}

/// Whether a property holds at the hub of every rotor, given as (rotor, x_m, z_m) in the plane.
template <class Predicate>
bool all_rotors(const FlightModel& model, const FlightState& state, const Predicate& predicate) {
    const PlantModel& plant = model.tick().plant;
    const auto attitude = dynamics::attitude(plant, state.plant.q[2], state.plant.q[3]);
    for (int i = 0; i < plant.rotor_count; ++i) {
        const auto hub = dynamics::rotor_position(plant, attitude, state.plant.q[0], state.plant.q[1], i);
        if (!predicate(i, hub.x, hub.z)) {
            return false;
        }
    }
    return true;
}

/// Flies a segment tick by tick until `after` finds a fault.
/// @param integrate see tick()   @param after callable (before, reference, record, next, next_reference) -> FlightFault
template <class Factor, class Integrate, class After>
FlightFault fly_ticks(const TickModel& model, const ReferenceSegment& segment, const Factor& factor,
                      const Integrate& integrate, FlightState& state, After&& after) {
    ReferencePoint reference = segment.from();
    for (std::int64_t t = 0; t < segment.ticks(); ++t) {
        TickRecord<double> record{};
        const FlightState next = tick(model, state, setpoint(reference), factor, record, integrate);
        const ReferencePoint next_reference = segment.at_tick(t + 1);
        const FlightFault fault = after(state, reference, record, next, next_reference);
        state = next;
        reference = next_reference;
        if (fault != FlightFault::none) {
            return fault;
        }
    }
    return FlightFault::none;
}

}  // namespace downwash::simulation
