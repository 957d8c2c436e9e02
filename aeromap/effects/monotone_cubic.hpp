#pragma once

#include "downwash/base/lane_math.hpp"

// Piecewise cubic Hermite interpolation that never leaves the range of neighbouring values (PCHIP): slopes after
// Fritsch and Butland 1984, SIAM J. Sci. Stat. Comput. 5(2), as in Boost.Math and MATLAB. At either end of the
// data the slope is the secant of the outermost interval.
namespace downwash::monotone_cubic {

/// Slope at a point between two intervals: a weighted harmonic mean of their secants, 0 at an extremum.
/// @param h_left, h_right widths of the intervals, > 0
inline double slope(double h_left, double secant_left, double h_right, double secant_right) {
    const bool is_monotone = (secant_left > 0 && secant_right > 0) || (secant_left < 0 && secant_right < 0);
    if (!is_monotone) {
        return 0;
    }
    const double weight_left = 2 * h_right + h_left;
    const double weight_right = h_right + 2 * h_left;
    return (weight_left + weight_right) / (weight_left / secant_left + weight_right / secant_right);
}

/// Hermite weights of the values and slopes at an interval's ends, for a point inside.
struct Weights {
    double left, right;              ///< weights of the values at both ends
    double slope_left, slope_right;  ///< weights of the slopes at both ends
};

/// The weights at a point.
/// @param h width of the interval, > 0   @param t in [0, 1], from its left end to its right
inline Weights weights(double h, double t) {
    const double rest = 1 - t;
    const double right = t * t * (3 - 2 * t);
    return {1 - right, right, h * t * rest * rest, -h * t * t * rest};
}

/// Cubic with these values and slopes at the ends, kept between the values whatever rounding does.
inline double value(const Weights& weights, double left, double right, double slope_left, double slope_right) {
    const double sum = weights.left * left + weights.right * right + weights.slope_left * slope_left +
                       weights.slope_right * slope_right;
    return lane::clamp(sum, lane::min(left, right), lane::max(left, right));
}

}  // namespace downwash::monotone_cubic
