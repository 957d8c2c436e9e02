#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/world_numbers.hpp"

// What a world does in one tick to what the controller sees, to the air and to its own memory. One template over the
// lane type.

namespace downwash::simulation {

/// How late a controller sees, in shares of the states at the last ticks: linear between two of them.
template <class T>
struct Lateness {
    T share[max_delay_ticks + 1];      ///< of the state so many ticks ago
    bool counts[max_delay_ticks + 1];  ///< false where the share is 0 in every lane
};

/// @param delay_ticks age of what the controller sees, 0 to max_delay_ticks
template <class T>
Lateness<T> lateness(const T& delay_ticks) {
    Lateness<T> late;
    for (int age = 0; age <= max_delay_ticks; ++age) {
        // 1 less the distance in ticks from the wanted age.
        late.share[age] = lane::max(T(0), T(1) - lane::abs(delay_ticks - T(age)));
        late.counts[age] = lane::bits_of(late.share[age] > T(0)) != 0;
    }
    return late;
}

/// The vehicle late, before any error of what the controller sees: it knows the rotors' speeds at once.
/// @param past `past(age)` is the PastMotion so many ticks ago, from 1 on   @param[out] seen not `now` itself
template <class T, class Past>
void look_back(const Lateness<T>& late, const dynamics::PlantState<T>& now, const Past& past,
               dynamics::PlantState<T>& seen) {
    for (int i = 0; i < 4; ++i) {
        seen.q[i] = seen.u[i] = T(0);
    }
    const auto add = [&](const T& share, const T q[4], const T u[4]) {
        for (int i = 0; i < 4; ++i) {
            seen.q[i] = seen.q[i] + share * q[i];
            seen.u[i] = seen.u[i] + share * u[i];
        }
    };
    if (late.counts[0]) {
        add(late.share[0], now.q, now.u);
    }
    for (int age = 1; age <= max_delay_ticks; ++age) {
        if (late.counts[age]) {
            const PastMotion<T>& then = past(age);
            add(late.share[age], then.q, then.u);
        }
    }
    for (int i = 0; i < max_rotors; ++i) {
        seen.thrust_n[i] = now.thrust_n[i];
    }
    seen.energy_j = now.energy_j;
}

/// Adds bias and noise of a tick to what the controller sees. It knows the arm's angle exactly.
/// @param noise standard normal numbers of this tick
template <class T>
void add_errors(const WorldNumbers<T>& world, const T noise[noise_count], dynamics::PlantState<T>& seen) {
    for (int axis = 0; axis < 2; ++axis) {
        seen.q[axis] = seen.q[axis] + (world.position_bias_m[axis] + world.position_noise_m * noise[axis]);
        seen.u[axis] = seen.u[axis] + world.velocity_noise_m_s * noise[2 + axis];
    }
    seen.q[2] = seen.q[2] + world.pitch_bias_rad;
    seen.u[2] = seen.u[2] + world.gyro_noise_rad_s * noise[4];
}

/// What the controller sees: late, biased and noisy.
/// @param noise standard normal numbers of this tick
template <class T>
dynamics::PlantState<T> seen_state(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now,
                                   const WorldMemory<T>& memory, const T noise[noise_count]) {
    dynamics::PlantState<T> seen;
    look_back(
        lateness(world.delay_ticks), now, [&](int age) -> const PastMotion<T>& { return memory.past[age - 1]; }, seen);
    add_errors(world, noise, seen);
    return seen;
}

/// Steady wind and gusts of a tick [m/s] (Dryden; MIL-F-8785C 3.7.2).
/// @param gust see WorldMemory
template <class T>
dynamics::PlanePoint<T> wind_in(const WorldNumbers<T>& world, const T gust[3]) {
    constexpr double root3 = 1.7320508075688772;
    const T along_z = T(root3) * gust[1] + T(1 - root3) * gust[2];
    return {world.wind_m_s[0] + world.gust_m_s * gust[0], world.wind_m_s[1] + world.gust_m_s * along_z};
}
template <class T>
dynamics::PlanePoint<T> wind_in(const WorldNumbers<T>& world, const WorldMemory<T>& memory) {
    return wind_in(world, memory.gust);
}

/// The filters of the gusts one tick later.
/// @param[in,out] gust see WorldMemory   @param noise standard normal numbers of the tick
template <class T>
void pass_gusts(const WorldNumbers<T>& world, const T noise[noise_count], T gust[3]) {
    const T first_z = gust[1];
    gust[0] = world.gust_x_decay * gust[0] + world.gust_x_noise * noise[5];
    gust[1] = world.gust_z_decay * first_z + world.gust_z_noise[0] * noise[6];
    gust[2] = world.gust_z_decay * gust[2] + world.gust_z_coupling * first_z +
              (world.gust_z_noise[1] * noise[6] + world.gust_z_noise[2] * noise[7]);
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
    for (int i = 0; i < 3; ++i) {
        next.gust[i] = memory.gust[i];
    }
    pass_gusts(world, noise, next.gust);
    return next;
}

}  // namespace downwash::simulation
