#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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
                // Of equal values exactly 0: what does not change along an axis has no part there.
                const double to_middle = middle - low;
                const double to_high = high - low;
                middle = 4 * to_middle - to_high;
                high = 2 * (to_high - 2 * to_middle);
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

/// How far a polynomial varies: 0 not at all, 1 along z alone, 2 along y, too, 3 along x, too.
[[gnu::always_inline]] inline int varying_axes(const Triquadratic& coefficients) {
    typedef std::uint32_t Row __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
    const auto row = [&](std::size_t first) __attribute__((always_inline)) {
        Row bits;
        std::memcpy(&bits, &coefficients[first], sizeof bits);
        return bits;
    };
    constexpr std::uint32_t all_but_sign = 0x7fffffff;
    const Row of_z = row(9) | row(18);
    const Row of_y = row(3) | row(6) | row(12) | row(15) | row(21) | row(24);
    const Row any = row(0) | of_y | of_z;
    if (((any[1] | any[2]) & all_but_sign) != 0) {
        return 3;
    }
    if ((of_y[0] & all_but_sign) != 0) {
        return 2;
    }
    return (of_z[0] & all_but_sign) != 0 ? 1 : 0;
}

/// A parabola in z from the coefficients 0, 9 and 18 of a Triquadratic, and products of parabolas in y and z.
template <class T, class Coefficient>
T parabola_at(const Coefficient& coefficient, const T& z) {
    return coefficient(0) + z * (coefficient(9) + z * coefficient(18));
}
template <class T, class Coefficient>
T biquadratic_at(const Coefficient& coefficient, const T& y, const T& z) {
    const auto of_power = [&](int power) {
        return parabola_at([&](int number) { return coefficient(3 * power + number); }, z);
    };
    return of_power(0) + y * (of_power(1) + y * of_power(2));
}

/// The same in double, from 27 coefficients. One template over the lane type: the lanes' coefficients may differ.
/// @param coefficient gives that of a number
template <class T, class Coefficient>
T triquadratic_at(const Coefficient& coefficient, const T& x, const T& y, const T& z) {
    const auto of_power = [&](int power) {
        return biquadratic_at([&](int number) { return coefficient(power + number); }, y, z);
    };
    return of_power(0) + x * (of_power(1) + x * of_power(2));
}

}  // namespace downwash
