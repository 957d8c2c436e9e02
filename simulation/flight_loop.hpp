#pragma once

#include <cmath>

#include "downwash/simulation/flight.hpp"

// What planning and execution share of flying a segment: the loop over ticks and the sources of surface effect.

namespace downwash::simulation {

/// No surface effect anywhere.
struct NoEffect {
    /// K = 1 at any hub.
    double operator()(int, double, double) const noexcept { return 1; }
    /// All rotors share the first one's.
    [[nodiscard]] int same_as(int) const noexcept { return 0; }
};

/// The effect looked up in a map along one flight. Rotors one behind the other as seen along the lateral axis share a
/// look-up where their layers hold the same, and every rotor remembers the patch of the map that it is in: the values
/// are those of AeroMap::factor() to the last bit. Not to be shared between threads.
class MapEffect {
 public:
    /// @pre both outlive the object, and the map has the model's layers
    MapEffect(const FlightModel& model, const AeroMap& map) : model_(model), map_(map) {
        const PlantModel& plant = model.tick().plant;
        for (int i = 0; i < plant.rotor_count + (plant.has_fountain ? 1 : 0); ++i) {
            layers_[i].view = map.view(model.rotor_layer(i));
        }
        for (int i = 0; i < plant.rotor_count; ++i) {
            same_as_[i] = i;
            for (int j = i; j-- > 0;) {
                if (plant.rotor_x_m[i] == plant.rotor_x_m[j] && plant.rotor_z_m[i] == plant.rotor_z_m[j] &&
                    map.are_equal(model.rotor_layer(i), model.rotor_layer(j))) {
                    same_as_[i] = j;
                }
            }
        }
    }
    /// K at the hub of a rotor, or of the body, in the plane.
    double operator()(int rotor, double x_m, double z_m) const noexcept {
        Layer& layer = layers_[rotor];
        const double u = (x_m - layer.view.x_low_m) * layer.view.cells_per_m;
        const double w = (z_m - layer.view.z_low_m) * layer.view.cells_per_m;
        double s = (u - layer.patch.u) * layer.patch.steps_x;
        double t = (w - layer.patch.w) * layer.patch.steps_z;
        if (!is_in_patch(s, t)) {
            if (!layer.view.contains(u, w)) {
                return map_.factor(model_.rotor_layer(rotor), x_m, z_m);
            }
            layer.patch = patch_at(layer.view, u, w);
            s = (u - layer.patch.u) * layer.patch.steps_x;
            t = (w - layer.patch.w) * layer.patch.steps_z;
        }
        return bilinear(layer.patch.corner, s, t);
    }
    /// The earliest rotor, or the rotor itself, that shares its look-up.
    [[nodiscard]] int same_as(int rotor) const noexcept { return same_as_[rotor]; }

 private:
    struct Layer {
        MapView view;
        MapPatch patch = no_patch;
    };

    const FlightModel& model_;
    const AeroMap& map_;
    mutable Layer layers_[max_rotors + 1];
    int same_as_[max_rotors] = {};
};

/// The effect evaluated exactly.
struct DirectFactor {
    const FlightModel& model;
    /// K at the hub of a rotor, or of the body, in the plane.
    double operator()(int rotor, double x_m, double z_m) const { return model.direct_factor(rotor, x_m, z_m); }
};

/// A point of a reference as the controller takes it.
inline controllers::Setpoint<double> setpoint(const ReferencePoint& point) noexcept {
    controllers::Setpoint<double> s;
    for (int i = 0; i < 3; ++i) {
        s.position[i] = point.position[i];
        s.velocity[i] = point.velocity[i];
        s.acceleration[i] = point.acceleration[i];
    }
    return s;
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

/// Flies a segment tick by tick until `after` finds a rejection.
/// @param integrate see tick()   @param after callable (before, reference, record, next, next_reference) -> Rejection
template <class Factor, class Integrate, class After>
Rejection fly_ticks(const TickModel& model, const ReferenceSegment& segment, const Factor& factor,
                    const Integrate& integrate, FlightState& state, After&& after) {
    ReferencePoint reference = segment.from();
    for (std::int64_t t = 0; t < segment.ticks(); ++t) {
        TickRecord<double> record{};
        const FlightState next = tick(model, state, setpoint(reference), factor, record, integrate);
        const ReferencePoint next_reference = segment.at_tick(t + 1);
        const Rejection rejection = after(state, reference, record, next, next_reference);
        state = next;
        reference = next_reference;
        if (rejection != Rejection::none) {
            return rejection;
        }
    }
    return Rejection::none;
}

}  // namespace downwash::simulation
