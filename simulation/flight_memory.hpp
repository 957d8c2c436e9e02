#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "downwash/simulation/world_numbers.hpp"

// What a world remembers of one flight, as far back as its delay reaches.

namespace downwash::simulation {

/// What a world remembers of a flight one lane wide. Flights with short delays copy, keep and compare no more than
/// WorldMemory.
struct FlightMemory : WorldMemory<double> {
    /// Where the vehicle was recent_ticks + 1 ticks ago, one tick before that, ...: as many as the delay needs. Empty
    /// where it needs none, and where the vehicle was always where the last of `past` is.
    std::vector<PastMotion<double>> older;
};

/// A delay in ticks. A long one that is a whole number of ticks but for rounding is just that: no state is remembered
/// for a share of nothing.
[[nodiscard]] inline double delay_ticks(double delay_s, double rate_hz) noexcept {
    const double ticks = delay_s * rate_hz;
    const double whole = std::round(ticks);
    return ticks > recent_ticks && std::abs(ticks - whole) <= 1e-9 * whole ? whole : ticks;
}

/// How many older motions a delay needs.
[[nodiscard]] inline std::size_t older_ticks(double delay_ticks) noexcept {
    return delay_ticks > recent_ticks ? static_cast<std::size_t>(std::ceil(delay_ticks)) - recent_ticks : 0;
}

/// Where the vehicle was so many ticks ago, from 1 on. Before what is remembered it was always in the same place.
/// @tparam Memory FlightMemory, or that of a flight in space
template <class Memory>
[[nodiscard]] const auto& past_at(const Memory& memory, int age) noexcept {
    if (age <= recent_ticks) {
        return memory.past[age - 1];
    }
    if (memory.older.empty()) {
        return memory.past[recent_ticks - 1];
    }
    return memory.older[std::min(static_cast<std::size_t>(age - recent_ticks), memory.older.size()) - 1];
}

/// Remembers as many older motions as a world's delay needs; those that are not known are the oldest that is.
inline void remember_older(const WorldNumbers<double>& world, FlightMemory& memory) {
    memory.older.resize(older_ticks(world.delay_ticks), past_at(memory, max_delay_ticks));
}

}  // namespace downwash::simulation
