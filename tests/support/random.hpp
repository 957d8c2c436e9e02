#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace downwash::test {

/// Repeatable numbers, the same on every machine and with every standard library.
class Random {
 public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
    }
    /// A whole number in [low, high].
    int integer(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    /// Either sign, magnitudes spread evenly over the decades between 10^low and 10^high.
    double magnitude(double low, double high) {
        const double size = std::pow(10.0, uniform(low, high));
        return engine_() % 2 == 0 ? size : -size;
    }

 private:
    std::mt19937_64 engine_;
};

}  // namespace downwash::test
