#pragma once

// Private to aeromap.

#include <array>
#include <cstddef>

namespace downwash {

/// Weights of the values at 0, 1/2 and 1 in the parabola through them at s.
inline std::array<double, 3> parabola_weights(double s) {
    const double rest = 1 - s;
    return {rest * (rest - s), 4 * s * rest, s * (s - rest)};
}

/// The product of parabolas along three axes through 3 x 3 x 3 values, the first axis running fastest.
/// @param at from 0 to 1 along each axis
template <class Values>
double triquadratic(const Values& values, const std::array<double, 3>& at) {
    const auto x = parabola_weights(at[0]);
    const auto y = parabola_weights(at[1]);
    const auto z = parabola_weights(at[2]);
    double sum = 0;
    for (std::size_t layer = 0; layer < 3; ++layer) {
        double in_layer = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            const std::size_t n = 9 * layer + 3 * row;
            in_layer += y[row] * (x[0] * values[n] + x[1] * values[n + 1] + x[2] * values[n + 2]);
        }
        sum += z[layer] * in_layer;
    }
    return sum;
}

}  // namespace downwash
