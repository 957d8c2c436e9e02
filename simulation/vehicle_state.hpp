#pragma once

#include "downwash/controllers/control_law.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/world_numbers.hpp"

namespace downwash {
namespace simulation {

/// What the plain tick changes: bodies, rotor lag, energy, and every integrator. Nothing but T: see base/numbers.hpp.
template <class T>
struct VehicleState {
    dynamics::PlantState<T> plant;
    controllers::LawMemory<T> memory;
};

/// Everything about the vehicle that changes in flight, with what its world remembers. Nothing but T.
template <class T>
struct State : VehicleState<T> {
    WorldMemory<T> world;  ///< the plain tick leaves it as it is
};

}  // namespace simulation

/// The state of a flight, one lane wide.
using FlightState = simulation::State<double>;

}  // namespace downwash
