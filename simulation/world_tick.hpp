#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/flight_memory.hpp"
#include "downwash/simulation/gusts.hpp"
#include "downwash/simulation/world_numbers.hpp"

// What a world does in one tick to what the controller sees, to the air and to its own memory. One template over the
// lane type.

namespace downwash::simulation {

/// How late a controller sees, in shares of the states at the last ticks: linear between two of them.
template <class T>
struct Lateness {
    T share[recent_ticks + 1];      ///< of the state so many ticks ago
    bool counts[recent_ticks + 1];  ///< false where the share is 0 in every lane
    T delay_ticks;
    int first_older, last_older;  ///< ages beyond recent_ticks of which some lane has a share; none if last < first
};

/// The share of the state so many ticks ago: 1 less the distance in ticks from the wanted age.
template <class T>
T share_of_age(const T& delay_ticks, int age) {
    return lane::max(T(0), T(1) - lane::abs(delay_ticks - T(age)));
}

/// @param delay_ticks age of what the controller sees, 0 to max_delay_ticks
template <class T>
Lateness<T> lateness(const T& delay_ticks) {
    Lateness<T> late;
    for (int age = 0; age <= recent_ticks; ++age) {
        late.share[age] = share_of_age(delay_ticks, age);
        late.counts[age] = lane::bits_of(late.share[age] > T(0)) != 0;
    }
    late.delay_ticks = delay_ticks;
    late.first_older = recent_ticks + 1;
    late.last_older = recent_ticks;
    if (lane::bits_of(delay_ticks > T(recent_ticks)) == 0) {
        return late;
    }
    for (int age = recent_ticks + 1; age <= max_delay_ticks; ++age) {
        if (lane::bits_of(share_of_age(delay_ticks, age) > T(0)) != 0) {
            late.first_older = late.last_older == recent_ticks ? age : late.first_older;
            late.last_older = age;
        }
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
    for (int age = 1; age <= recent_ticks; ++age) {
        if (late.counts[age]) {
            const PastMotion<T>& then = past(age);
            add(late.share[age], then.q, then.u);
        }
    }
    for (int age = late.first_older; age <= late.last_older; ++age) {
        const PastMotion<T>& then = past(age);
        add(share_of_age(late.delay_ticks, age), then.q, then.u);
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
/// @param past see look_back()   @param noise standard normal numbers of this tick
template <class T, class Past>
dynamics::PlantState<T> seen_through(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now, const Past& past,
                                     const T noise[noise_count]) {
    dynamics::PlantState<T> seen;
    look_back(lateness(world.delay_ticks), now, past, seen);
    add_errors(world, noise, seen);
    return seen;
}

/// The same from what a world remembers. @pre its delay is at most recent_ticks
template <class T>
dynamics::PlantState<T> seen_state(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now,
                                   const WorldMemory<T>& memory, const T noise[noise_count]) {
    return seen_through(
        world, now, [&](int age) -> const PastMotion<T>& { return memory.past[age - 1]; }, noise);
}

/// Steady wind and gusts of a tick [m/s] (Dryden; MIL-F-8785C 3.7.2).
/// @param gust see WorldMemory
template <class T>
dynamics::PlanePoint<T> wind_in(const WorldNumbers<T>& world, const T gust[3]) {
    return {world.wind_m_s[0] + world.gust_m_s * gust[0],
            world.wind_m_s[1] + world.gust_m_s * gust_across(gust[1], gust[2])};
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

/// The memory one tick later. @param[out] next not the memory itself
template <class T>
void pass_tick(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now, const WorldMemory<T>& memory,
               const T noise[noise_count], WorldMemory<T>& next) {
    for (int age = recent_ticks - 1; age > 0; --age) {
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
}

/// See seen_state() of WorldMemory; for any delay.
[[nodiscard]] inline dynamics::PlantState<double> seen_state(const WorldNumbers<double>& world,
                                                             const dynamics::PlantState<double>& now,
                                                             const FlightMemory& memory,
                                                             const double noise[noise_count]) {
    return seen_through(
        world, now, [&](int age) -> const PastMotion<double>& { return past_at(memory, age); }, noise);
}

/// The memory one tick later. It allocates nothing where `next` is that of an earlier tick of the flight.
/// @param[out] next not the memory itself
inline void pass_tick(const WorldNumbers<double>& world, const dynamics::PlantState<double>& now,
                      const FlightMemory& memory, const double noise[noise_count], FlightMemory& next) {
    const WorldMemory<double>& recent = memory;
    WorldMemory<double>& next_recent = next;
    pass_tick(world, now, recent, noise, next_recent);
    next.older.resize(older_ticks(world.delay_ticks));
    for (std::size_t i = 0; i < next.older.size(); ++i) {
        next.older[i] = past_at(memory, recent_ticks + static_cast<int>(i));
    }
}

}  // namespace downwash::simulation
