#include "downwash/aeromap/curve_mean.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "downwash/aeromap/gauss_rule.hpp"

namespace downwash {
namespace {

constexpr double reach = 16;  ///< of the table, in radii; farther out k falls like one over the square
constexpr std::size_t intervals = 1024;
/// Over a shorter range the middle says as much as the integral, and more exactly.
constexpr double short_range = 1e-3;

/// Distance of node i from the start: close to the cap k is steepest.
double node_distance(double i) {
    return reach * (i / intervals) * (i / intervals);
}

}  // namespace

CurveMean::CurveMean(const EffectCurve& curve)
    : curve_(curve), start_(std::max(0.0, curve.cap_distance())), start_factor_(curve(0)) {
    assert(curve.falls_with_distance() && !curve.depends_on_wall());
    nodes_.reserve(intervals + 1);
    nodes_.push_back({0, curve(start_)});
    for (std::size_t i = 1; i <= intervals; ++i) {
        const double low = start_ + node_distance(static_cast<double>(i - 1));
        const double high = start_ + node_distance(static_cast<double>(i));
        nodes_.push_back({nodes_.back().integral + integrate(plain_6, low, high, curve), curve(high)});
    }
}

double CurveMean::operator()(double one, double other) const {
    const double range = other - one;
    if (std::abs(range) < short_range) {
        return curve_(0.5 * (one + other));
    }
    return (integral_to(other) - integral_to(one)) / range;
}

/// Negative before the start.
double CurveMean::integral_to(double distance) const noexcept {
    const double beyond = distance - start_;
    if (beyond <= 0) {
        return start_factor_ * beyond;
    }
    if (beyond >= reach) {
        const double change = nodes_.back().factor - 1;
        const double last = start_ + reach;
        return nodes_.back().integral + (beyond - reach) + change * last * (1 - last / distance);
    }
    const double place = std::sqrt(beyond / reach) * intervals;
    const std::size_t i = std::min(static_cast<std::size_t>(place), intervals - 1);
    const double low = node_distance(static_cast<double>(i));
    const double width = node_distance(static_cast<double>(i + 1)) - low;
    const double s = (beyond - low) / width;
    const Node& a = nodes_[i];
    const Node& b = nodes_[i + 1];
    // Hermite's cubic through both integrals and both factors, their slopes.
    const double rise = b.integral - a.integral;
    const double slope = width * a.factor;
    return a.integral +
           s * (slope + s * (3 * rise - 2 * slope - width * b.factor + s * (slope + width * b.factor - 2 * rise)));
}

}  // namespace downwash
