#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/simulation/gusts.hpp"
#include "downwash/simulation/space_world.hpp"
#include "downwash/simulation/world_tick.hpp"

// What a world in space does in one tick to what the controller sees, to the air and to its own memory. One template
// over the lane type and the number of joints; world_tick.hpp has that of the plane.

namespace downwash::simulation {

/// The vehicle late, before any error of what the controller sees: it knows the rotors' speeds at once. Numbers are
/// linear between two ticks, so that the quaternion need not be of length 1.
/// @param past `past(age)` is the PastSpaceMotion so many ticks ago, from 1 on   @param[out] seen not `now` itself
template <class T, int n, class Past>
void look_back(const Lateness<T>& late, const dynamics::SpaceState<T, n>& now, const Past& past,
               dynamics::SpaceState<T, n>& seen) {
    for (T& number : seen.q) {
        number = T(0);
    }
    for (T& number : seen.u) {
        number = T(0);
    }
    const auto add = [&](const T& share, const T* q, const T* u) {
        for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
            seen.q[i] = seen.q[i] + share * q[i];
        }
        for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
            seen.u[i] = seen.u[i] + share * u[i];
        }
    };
    if (late.counts[0]) {
        add(late.share[0], now.q, now.u);
    }
    for (int age = 1; age <= recent_ticks; ++age) {
        if (late.counts[age]) {
            const PastSpaceMotion<T, n>& then = past(age);
            add(late.share[age], then.q, then.u);
        }
    }
    for (int age = late.first_older; age <= late.last_older; ++age) {
        const PastSpaceMotion<T, n>& then = past(age);
        add(share_of_age(late.delay_ticks, age), then.q, then.u);
    }
    for (int i = 0; i < max_rotors; ++i) {
        seen.thrust_n[i] = now.thrust_n[i];
    }
    seen.energy_j = now.energy_j;
}

/// Adds bias and noise of a tick to what the controller sees.
/// @param noise standard normal numbers of this tick
template <class T, int n>
void add_errors(const SpaceWorldNumbers<T, n>& world, const T noise[space_noise_count],
                dynamics::SpaceState<T, n>& seen) {
    const T bias_m[3] = {world.position_bias_m.x, world.position_bias_m.y, world.position_bias_m.z};
    for (int axis = 0; axis < 3; ++axis) {
        seen.q[axis] = seen.q[axis] + (bias_m[axis] + world.position_noise_m * noise[axis]);
        seen.u[axis] = seen.u[axis] + world.velocity_noise_m_s * noise[3 + axis];
        seen.u[3 + axis] = seen.u[3 + axis] + world.gyro_noise_rad_s * noise[6 + axis];
    }
    const T* a = seen.q + 3;
    const T* b = world.attitude_bias;
    const T turned[4] = {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
    for (int i = 0; i < 4; ++i) {
        seen.q[3 + i] = turned[i];
    }
    for (int i = 0; i < n; ++i) {
        seen.q[7 + i] = seen.q[7 + i] + world.joint_offset_rad[i];
    }
}

/// What the controller sees: late, biased and noisy.
/// @param past see look_back()   @param noise standard normal numbers of this tick
template <class T, int n, class Past>
dynamics::SpaceState<T, n> seen_through(const SpaceWorldNumbers<T, n>& world, const dynamics::SpaceState<T, n>& now,
                                        const Past& past, const T noise[space_noise_count]) {
    dynamics::SpaceState<T, n> seen;
    look_back(lateness(world.delay_ticks), now, past, seen);
    add_errors(world, noise, seen);
    return seen;
}

/// The same from what a world remembers. @pre its delay is at most recent_ticks
template <class T, int n>
dynamics::SpaceState<T, n> seen_state(const SpaceWorldNumbers<T, n>& world, const dynamics::SpaceState<T, n>& now,
                                      const SpaceWorldMemory<T, n>& memory, const T noise[space_noise_count]) {
    return seen_through(
        world, now, [&](int age) -> const PastSpaceMotion<T, n>& { return memory.past[age - 1]; }, noise);
}

/// Steady wind and gusts of a tick [m/s], world axes.
/// @param gust see SpaceWorldMemory
template <class T>
dynamics::LaneVector<T> wind_in(const SpaceWorldDifferences<T>& world, const T gust[5]) {
    const T along = world.gust_m_s * gust[0];
    const T left = world.gust_m_s * gust_across(gust[1], gust[2]);
    const T up = world.gust_m_s * gust_across(gust[3], gust[4]);
    return {world.wind_m_s.x + (world.gust_cosine * along - world.gust_sine * left),
            world.wind_m_s.y + (world.gust_sine * along + world.gust_cosine * left), world.wind_m_s.z + up};
}

/// A filter across the way one tick later. @param[in,out] state y1 and y2   @param first,second standard normal numbers
template <class T>
void pass_gust_pair(const GustPairNumbers<T>& filter, const T& first, const T& second, T state[2]) {
    const T before = state[0];
    state[0] = filter.decay * before + filter.noise[0] * first;
    state[1] =
        filter.decay * state[1] + filter.coupling * before + (filter.noise[1] * first + filter.noise[2] * second);
}

/// The filters of the gusts one tick later.
/// @param noise standard normal numbers of the tick   @param[in,out] gust see SpaceWorldMemory
template <class T>
void pass_gusts(const SpaceWorldDifferences<T>& world, const T noise[space_noise_count], T gust[5]) {
    gust[0] = world.gust_decay * gust[0] + world.gust_noise * noise[9];
    pass_gust_pair(world.gust_left, noise[10], noise[11], gust + 1);
    pass_gust_pair(world.gust_up, noise[12], noise[13], gust + 3);
}

/// The memory one tick later. @param[out] next not the memory itself
template <class T, int n>
void pass_tick(const SpaceWorldDifferences<T>& world, const dynamics::SpaceState<T, n>& now,
               const SpaceWorldMemory<T, n>& memory, const T noise[space_noise_count], SpaceWorldMemory<T, n>& next) {
    for (int age = recent_ticks - 1; age > 0; --age) {
        next.past[age] = memory.past[age - 1];
    }
    for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
        next.past[0].q[i] = now.q[i];
    }
    for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
        next.past[0].u[i] = now.u[i];
    }
    for (int i = 0; i < 5; ++i) {
        next.gust[i] = memory.gust[i];
    }
    pass_gusts(world, noise, next.gust);
}

/// See seen_state() of SpaceWorldMemory; for any delay.
template <int n>
[[nodiscard]] dynamics::SpaceState<double, n> seen_state(const SpaceWorldNumbers<double, n>& world,
                                                         const dynamics::SpaceState<double, n>& now,
                                                         const SpaceFlightMemory<n>& memory,
                                                         const double noise[space_noise_count]) {
    return seen_through(
        world, now, [&](int age) -> const PastSpaceMotion<double, n>& { return past_at(memory, age); }, noise);
}

/// The memory one tick later. It allocates nothing where `next` is that of an earlier tick of the flight.
/// @param[out] next not the memory itself
template <int n>
void pass_tick(const SpaceWorldDifferences<double>& world, const dynamics::SpaceState<double, n>& now,
               const SpaceFlightMemory<n>& memory, const double noise[space_noise_count], SpaceFlightMemory<n>& next) {
    const SpaceWorldMemory<double, n>& recent = memory;
    SpaceWorldMemory<double, n>& next_recent = next;
    pass_tick(world, now, recent, noise, next_recent);
    next.older.resize(older_ticks(world.delay_ticks));
    for (std::size_t i = 0; i < next.older.size(); ++i) {
        next.older[i] = past_at(memory, recent_ticks + static_cast<int>(i));
    }
}

}  // namespace downwash::simulation
