#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/closed_loop.hpp"

namespace downwash {

/// What a flight adds up tick by tick, for objectives: numbers of the lane type only.
template <class T>
struct BasicFlightSums {
    T length_m{};  ///< integral of sqrt(dx^2 + dz^2 + (w darm)^2), w = half the arm's length
};

/// Those of one flight.
using FlightSums = BasicFlightSums<double>;

namespace simulation {

/// Adds what one tick contributes.
template <class T>
void add_tick(BasicFlightSums<T>& sums, const PlantModel& plant, const VehicleState<T>& before,
              const VehicleState<T>& next) {
    const T dx = next.plant.q[0] - before.plant.q[0];
    const T dz = next.plant.q[1] - before.plant.q[1];
    const T da = T(0.5 * plant.arm_length_m) * (next.plant.q[3] - before.plant.q[3]);
    sums.length_m = sums.length_m + lane::sqrt(dx * dx + dz * dz + da * da);
}

}  // namespace simulation
}  // namespace downwash
