#pragma once

#include "downwash/base/export.hpp"

// The filters of the Dryden gusts (MIL-F-8785C 3.7.2; docs/model.md 9), sampled at the control ticks without loss of
// variance, for gusts of unit variance. Nothing here knows in how many directions a vehicle flies.

namespace downwash::simulation {

/// The filter of a gust along the way of the air: y' = decay y + noise w, with w standard normal.
struct GustFilter {
    double decay = 0, noise = 0;
};

/// The filter of a gust across the way of the air: y1' = decay y1 + noise[0] w1 and y2' = decay y2 + coupling y1 +
/// noise[1] w1 + noise[2] w2, with w1 and w2 standard normal. gust_across() makes a gust of y1 and y2.
struct GustPairFilter {
    double decay = 0, coupling = 0, noise[3] = {};
};

/// @param ticks by how many length scales the air passes in a tick: tick times speed over length, > 0
[[nodiscard]] DOWNWASH_EXPORT GustFilter gust_filter(double ticks);
/// @param ticks as of gust_filter()
[[nodiscard]] DOWNWASH_EXPORT GustPairFilter gust_pair_filter(double ticks);

/// The state of a filter across the way before its first tick, from two standard normal numbers.
/// @param[out] state y1 and y2
DOWNWASH_EXPORT void start_gust_pair(double first, double second, double state[2]);

/// A gust across the way of the air, of unit variance, from both states of its filter.
template <class T>
T gust_across(const T& first, const T& second) {
    constexpr double root3 = 1.7320508075688772;
    return T(root3) * first + T(1 - root3) * second;
}

}  // namespace downwash::simulation
