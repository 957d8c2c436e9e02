#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace downwash {

/// Weights of the values at 0, 1/2 and 1 in the parabola through them at s.
inline std::array<double, 3> parabola_weights(double s) {
    const double rest = 1 - s;
    return {rest * (rest - s), 4 * s * rest, s * (s - rest)};
}

/// A product of parabolas along x, y and z: the coefficient of x^i y^j z^k at i + 3 j + 9 k. The last number stays 0;
/// rows of three are read as four.
using Triquadratic = std::array<float, 28>;

/// Through 3 x 3 x 3 values at 0, 1/2 and 1 along each axis, x running fastest.
inline Triquadratic triquadratic_through(std::array<double, 27> values) {
    for (const std::size_t stride : {1U, 3U, 9U}) {
        for (std::size_t n = 0; n < values.size(); ++n) {
            if (n / stride % 3 == 0) {
                double& low = values[n];
                double& middle = values[n + stride];
                double& high = values[n + 2 * stride];
                const double slope = 4 * middle - 3 * low - high;
                high = 2 * (low + high) - 4 * middle;
                middle = slope;
            }
        }
    }
    Triquadratic coefficients{};
    for (std::size_t n = 0; n < values.size(); ++n) {
        coefficients[n] = static_cast<float>(values[n]);
    }
    return coefficients;
}

/// @param at from 0 to 1 along each axis
inline double value_at(const Triquadratic& coefficients, const std::array<double, 3>& at) {
    typedef float Row __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
    const auto read_row = [&](std::size_t first) {
        Row row;
        std::memcpy(&row, &coefficients[first], sizeof row);
        return row;
    };
    const auto x = static_cast<float>(at[0]);
    const auto y = static_cast<float>(at[1]);
    const auto z = static_cast<float>(at[2]);
    const auto in_x = [&](std::size_t first) {
        return read_row(first) + z * (read_row(first + 9) + z * read_row(first + 18));
    };
    const Row row = in_x(0) + y * (in_x(3) + y * in_x(6));
    return row[0] + x * (row[1] + x * row[2]);
}

/// The same in double, from 27 coefficients. One template over the lane type: the lanes' coefficients may differ.
/// @param coefficient gives that of a number
template <class T, class Coefficient>
T triquadratic_at(const Coefficient& coefficient, const T& x, const T& y, const T& z) {
    const auto in_x = [&](int first) {
        return coefficient(first) + z * (coefficient(first + 9) + z * coefficient(first + 18));
    };
    const auto of_power = [&](int power) { return in_x(power) + y * (in_x(power + 3) + y * in_x(power + 6)); };
    return of_power(0) + x * (of_power(1) + x * of_power(2));
}

}  // namespace downwash
