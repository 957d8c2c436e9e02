#include "downwash/aeromap/curve_mean.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "downwash/aeromap/gauss_rule.hpp"

namespace downwash {
namespace {

/// Distance of a piece's beginning from the start: close to the cap k is steepest.
double node_distance(double i, double intervals, double reach) {
    return reach * (i / intervals) * (i / intervals);
}

}  // namespace

CurveMean::CurveMean(const EffectCurve& curve)
    : curve_(curve), start_(std::max(0.0, curve.cap_distance())), start_factor_(curve(0)) {
    assert(curve.falls_with_distance() && !curve.depends_on_wall());
    pieces_.reserve(intervals);
    last_factor_ = curve(start_);
    for (std::uint32_t i = 0; i < intervals; ++i) {
        const double low = node_distance(i, intervals, reach);
        const double high = node_distance(i + 1, intervals, reach);
        const double width = high - low;
        const double rise = integrate(plain_6, start_ + low, start_ + high, curve);
        // Hermite's cubic through both integrals and both factors, their slopes.
        const double slope = width * last_factor_;
        last_factor_ = curve(start_ + high);
        const double last_slope = width * last_factor_;
        pieces_.push_back(
            {low, width, last_integral_, slope, 3 * rise - 2 * slope - last_slope, slope + last_slope - 2 * rise});
        last_integral_ += rise;
    }
    quick_.reserve(quick_steps);
    for (std::int32_t i = 0; i < quick_steps; ++i) {
        constexpr double step = 1.0 / steps_in_radius;
        const double low = start_ + i * step;
        const double integral = integral_to(low);
        const double rise = integral_to(low + step) - integral;
        const double slope = step * curve(low);
        const double last_slope = step * curve(low + step);
        quick_.push_back({integral, slope, 3 * rise - 2 * slope - last_slope, slope + last_slope - 2 * rise});
    }
}

double CurveMean::operator()(double one, double other) const {
    const double range = other - one;
    if (std::abs(range) < short_range) {
        return curve_(0.5 * (one + other));
    }
    return (integral_to(other) - integral_to(one)) / range;
}

}  // namespace downwash
