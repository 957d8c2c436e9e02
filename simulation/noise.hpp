#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/simulation/world_numbers.hpp"

// The noise of a world: a pure function of its tape and the control tick, so that an edge flown again is the same.
// Kernels for wide instructions include this: nothing here is a function that the linker could share.

namespace downwash::simulation {

/// How finely standard normal numbers are divided: 2^12 levels, each the mean over its share of the distribution.
inline constexpr int normal_level_bits = 12;

/// The levels, in rising order; of mean 0 and variance 1.
[[nodiscard]] DOWNWASH_EXPORT const float* normal_levels() noexcept;

/// A well mixed number (SplitMix64; Steele, Lea and Flood 2014).
[[nodiscard, gnu::always_inline]] inline std::uint64_t mixed(std::uint64_t x) noexcept {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

/// The standard normal numbers of a tick.
/// @param noise filled with noise_count numbers, `stride` apart
[[gnu::always_inline]] inline void draw_noise(const float* levels, std::uint64_t tape, std::int64_t tick, double* noise,
                                              int stride) noexcept {
    const std::uint64_t first = mixed(tape ^ mixed(static_cast<std::uint64_t>(tick)));
    std::uint64_t bits[] = {first, mixed(first)};
    constexpr int per_word = noise_count / 2;
    static_assert(per_word * normal_level_bits <= 64);
    for (int i = 0; i < noise_count; ++i) {
        std::uint64_t& word = bits[i / per_word];
        noise[i * stride] = static_cast<double>(levels[word >> (64U - normal_level_bits)]);
        word <<= static_cast<unsigned>(normal_level_bits);
    }
}

}  // namespace downwash::simulation
