#pragma once

#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::simulation {

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

}  // namespace downwash::simulation
