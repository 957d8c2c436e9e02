// The most sums and products of doubles that one thread can do: what ticks are compared with. Without contraction,
// as everything here is compiled; a processor that contracts does twice as many.

#include <benchmark/benchmark.h>

#include <cstdint>

#include "downwash/simulation/flight_batch.hpp"

using namespace downwash;

namespace {

constexpr std::int64_t rounds = 1000;
constexpr int chains = 12;  // as many as hide the latency and fit into sixteen registers

// A function for itself per width: vectors are lowered before anything is inlined.
#define DOWNWASH_SUMS_AND_PRODUCTS(name, width)                           \
    void name(double factor, double summand) {                            \
        typedef double Doubles __attribute__((vector_size(8 * (width)))); \
        const Doubles a = factor - Doubles{};                             \
        const Doubles b = summand - Doubles{};                            \
        Doubles x[chains] = {};                                           \
        for (std::int64_t i = 0; i < rounds; ++i) {                       \
            _Pragma("GCC unroll 12") for (Doubles & chain : x) {          \
                chain = chain * a + b;                                    \
            }                                                             \
        }                                                                 \
        for (Doubles & chain : x) {                                       \
            benchmark::DoNotOptimize(chain);                              \
        }                                                                 \
    }

DOWNWASH_SUMS_AND_PRODUCTS(in_twos, 2)
#if defined(__x86_64__)
[[gnu::target("avx2")]] DOWNWASH_SUMS_AND_PRODUCTS(in_fours, 4)
    [[gnu::target("avx512f")]] DOWNWASH_SUMS_AND_PRODUCTS(in_eights, 8)
#endif

        void peak(benchmark::State& state, void (*work)(double, double), int width) {
    double factor = 0.5;
    double summand = 1;
    benchmark::DoNotOptimize(factor);
    benchmark::DoNotOptimize(summand);
    for ([[maybe_unused]] auto _ : state) {
        work(factor, summand);
    }
    state.SetItemsProcessed(state.iterations() * rounds * chains * 2 * width);
}

[[maybe_unused]] const bool peaks_are_registered = [] {
    for (const Instructions instructions : known_instructions()) {
        switch (instructions) {
            case Instructions::baseline:
                benchmark::RegisterBenchmark("peak/baseline", peak, in_twos, 2);
                break;
#if defined(__x86_64__)
            case Instructions::avx2:
                benchmark::RegisterBenchmark("peak/avx2", peak, in_fours, 4);
                break;
            case Instructions::avx512:
                benchmark::RegisterBenchmark("peak/avx512", peak, in_eights, 8);
                break;
#endif
            default:
                break;
        }
    }
    return true;
}();

}  // namespace
