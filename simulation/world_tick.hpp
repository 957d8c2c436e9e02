#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/world_numbers.hpp"

// What a world does in one tick to what the controller sees, to the air and to its own memory. One template over the
// lane type.

namespace downwash::simulation {

/// What the controller sees: late, biased and noisy. It knows the arm's angle and the rotors' speeds exactly.
/// @param noise standard normal numbers of this tick
template <class T>
dynamics::PlantState<T> seen_state(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now,
                                   const WorldMemory<T>& memory, const T noise[noise_count]) {
    dynamics::PlantState<T> seen = now;
    // Linear between two ticks: a weight of 1 less the distance in ticks from the wanted age.
    const auto weight = [&](int age) { return lane::max(T(0), T(1) - lane::abs(world.delay_ticks - T(age))); };
    const T newest = weight(0);
    for (int i = 0; i < 4; ++i) {
        seen.q[i] = newest * now.q[i];
        seen.u[i] = newest * now.u[i];
    }
    for (int age = 1; age <= max_delay_ticks; ++age) {
        const T w = weight(age);
        const PastMotion<T>& past = memory.past[age - 1];
        for (int i = 0; i < 4; ++i) {
            seen.q[i] = seen.q[i] + w * past.q[i];
            seen.u[i] = seen.u[i] + w * past.u[i];
        }
    }
    for (int axis = 0; axis < 2; ++axis) {
        seen.q[axis] = seen.q[axis] + (world.position_bias_m[axis] + world.position_noise_m * noise[axis]);
        seen.u[axis] = seen.u[axis] + world.velocity_noise_m_s * noise[2 + axis];
    }
    seen.q[2] = seen.q[2] + world.pitch_bias_rad;
    seen.u[2] = seen.u[2] + world.gyro_noise_rad_s * noise[4];
    return seen;
}

/// Steady wind and gusts of a tick [m/s] (Dryden; MIL-F-8785C 3.7.2).
template <class T>
dynamics::PlanePoint<T> wind_in(const WorldNumbers<T>& world, const WorldMemory<T>& memory) {
    constexpr double root3 = 1.7320508075688772;
    const T along_z = T(root3) * memory.gust[1] + T(1 - root3) * memory.gust[2];
    return {world.wind_m_s[0] + world.gust_m_s * memory.gust[0], world.wind_m_s[1] + world.gust_m_s * along_z};
}

/// The memory one tick later.
template <class T>
WorldMemory<T> later(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now, const WorldMemory<T>& memory,
                     const T noise[noise_count]) {
    WorldMemory<T> next;
    for (int age = max_delay_ticks - 1; age > 0; --age) {
        next.past[age] = memory.past[age - 1];
    }
    for (int i = 0; i < 4; ++i) {
        next.past[0].q[i] = now.q[i];
        next.past[0].u[i] = now.u[i];
    }
    next.gust[0] = world.gust_x_decay * memory.gust[0] + world.gust_x_noise * noise[5];
    next.gust[1] = world.gust_z_decay * memory.gust[1] + world.gust_z_noise[0] * noise[6];
    next.gust[2] = world.gust_z_decay * memory.gust[2] + world.gust_z_coupling * memory.gust[1] +
                   (world.gust_z_noise[1] * noise[6] + world.gust_z_noise[2] * noise[7]);
    return next;
}

}  // namespace downwash::simulation
