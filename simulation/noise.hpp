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

/// A number between 0 and 1 from well mixed bits, evenly spread; neither end is among them.
[[nodiscard, gnu::always_inline]] inline double quantile_of(std::uint64_t bits) noexcept {
    return (static_cast<double>(bits >> 11U) + 0.5) * 0x1p-53;
}

/// Standard normal numbers of a tick.
/// @tparam count so many, `per_word` of them from each 64 random bits
/// @param noise filled with `count` numbers, `stride` apart
template <int count, int per_word>
[[gnu::always_inline]] inline void draw_normals(const float* levels, std::uint64_t tape, std::int64_t tick,
                                                double* noise, int stride) noexcept {
    static_assert(per_word * normal_level_bits <= 64);
    std::uint64_t bits[(count + per_word - 1) / per_word];
    std::uint64_t mixed_bits = tape ^ mixed(static_cast<std::uint64_t>(tick));
    for (std::uint64_t& word : bits) {
        mixed_bits = mixed(mixed_bits);
        word = mixed_bits;
    }
    for (int i = 0; i < count; ++i) {
        std::uint64_t& word = bits[i / per_word];
        noise[i * stride] = static_cast<double>(levels[word >> (64U - normal_level_bits)]);
        word <<= static_cast<unsigned>(normal_level_bits);
    }
}

/// The standard normal numbers of a tick in the plane.
/// @param noise filled with noise_count numbers, `stride` apart
[[gnu::always_inline]] inline void draw_noise(const float* levels, std::uint64_t tape, std::int64_t tick, double* noise,
                                              int stride) noexcept {
    draw_normals<noise_count, noise_count / 2>(levels, tape, tick, noise, stride);
}

/// The standard normal numbers of a tick in space.
/// @param noise filled with drawn_space_noise_count numbers, `stride` apart
[[gnu::always_inline]] inline void draw_space_noise(const float* levels, std::uint64_t tape, std::int64_t tick,
                                                    double* noise, int stride) noexcept {
    draw_normals<drawn_space_noise_count, 5>(levels, tape, tick, noise, stride);
}

}  // namespace downwash::simulation
