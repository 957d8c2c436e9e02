#pragma once

#include <cstdint>
#include <random>

namespace downwash {

/// Random numbers, seeded by the caller; the same on every machine.
class Random {
 public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [low, high).
    double uniform(double low, double high) {
        constexpr double scale = 0x1p-53;
        return low + (high - low) * (static_cast<double>(engine_() >> 11U) * scale);
    }

    /// A whole number from 0 to `count` - 1, each alike but for 2^-53. @pre 0 < count < 2^32
    std::size_t index(std::size_t count) { return static_cast<std::size_t>(uniform(0, static_cast<double>(count))); }

    /// Another source of numbers, which depends on what was drawn here before and on nothing that is drawn later.
    [[nodiscard]] Random branch() { return Random(engine_()); }

    /// True with this probability.
    bool chance(double probability) { return uniform(0, 1) < probability; }

    /// Whether both give the same numbers from now on.
    friend bool operator==(const Random& a, const Random& b) { return a.engine_ == b.engine_; }

 private:
    std::mt19937_64 engine_;
};

}  // namespace downwash
