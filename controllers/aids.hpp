#pragma once

#include <optional>

namespace downwash::controllers {

/// How a law observes what its model does not know.
struct DisturbanceObserver {
    double gain_1_s = 10;  ///< L: an estimate comes with a time constant of 1 / L
};

/// The map whose thrust ratios a law divides its rotor commands by.
struct FeedForward {
    double offset_x_m = 0;  ///< displacement of the map's surfaces from their nominal places
    double offset_z_m = 0;
};

/// What a law has beside its loops: an observer, a feed-forward.
struct Aids {
    std::optional<DisturbanceObserver> observer;  ///< empty: the law trusts its model
    std::optional<FeedForward> feed_forward;      ///< empty: the law knows no surfaces

    [[nodiscard]] bool are_any() const noexcept { return observer || feed_forward; }
};

}  // namespace downwash::controllers
