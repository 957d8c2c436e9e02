#pragma once

#include <algorithm>

#include "downwash/base/numbers.hpp"
#include "downwash/simulation/space_vehicle.hpp"

// Vehicles in flight whose number of joints is known at run time.

namespace downwash {

/// Everything about a vehicle in space that changes in flight, whatever its number of joints: what belongs to joints
/// that it lacks is 0. The law's memory is that of the vehicle's own number of joints.
using AnySpaceState = simulation::SpaceFlightState<double, max_joints>;

namespace simulation {

/// Copies what vehicles with different numbers of joints have in common. What belongs to other joints stays.
template <int from, int to>
void copy_common(const SpaceFlightState<double, from>& state, SpaceFlightState<double, to>& out) {
    constexpr int joints = std::min(from, to);
    constexpr int memory =
        std::min(number_count<double, SpaceLawMemory<double, from>>, number_count<double, SpaceLawMemory<double, to>>);
    const auto copy_motion = [](const auto& then, auto& past) {
        std::copy_n(then.q, dynamics::space_coordinates<joints>, past.q);
        std::copy_n(then.u, dynamics::space_speeds<joints>, past.u);
    };
    copy_motion(state.plant, out.plant);
    std::copy_n(state.plant.thrust_n, max_rotors, out.plant.thrust_n);
    out.plant.energy_j = state.plant.energy_j;
    std::copy_n(state.memory.number, memory, out.memory.number);
    for (int i = 0; i < recent_ticks; ++i) {
        copy_motion(state.world.past[i], out.world.past[i]);
    }
    std::copy_n(state.world.gust, 5, out.world.gust);
    out.world.older.resize(state.world.older.size());
    for (std::size_t i = 0; i < state.world.older.size(); ++i) {
        copy_motion(state.world.older[i], out.world.older[i]);
    }
}

}  // namespace simulation
}  // namespace downwash
