#pragma once

// Private to aeromap.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/effect_curve.hpp"

namespace downwash {

/// Means of a curve that falls with distance over ranges of distance, from its tabulated integral: what a surface does
/// along a line on which it is a straight slope. Immutable.
class CurveMean {
 public:
    /// @pre curve.falls_with_distance() and not curve.depends_on_wall()
    DOWNWASH_EXPORT explicit CurveMean(const EffectCurve& curve);

    /// Mean of k between two distances in radii, in either order; at least 0 and finite. Off by less than 1e-6 up to
    /// `reach` beyond the cap and by less than 1e-4 where a range reaches farther; over less than a thousandth of a
    /// radius k in the middle.
    [[nodiscard]] double operator()(double one, double other) const;

    /// Over a shorter range the middle says as much as the integral, and more exactly.
    static constexpr double short_range = 1e-3;

    /// The integral of k from the cap, or from 0 without one, to a distance in radii; negative before the cap.
    [[nodiscard]] double integral_to(double distance) const noexcept {
        const double beyond = distance - start_;
        if (beyond <= 0) {
            return start_factor_ * beyond;
        }
        if (beyond >= reach) {
            const double change = last_factor_ - 1;
            const double last = start_ + reach;
            return last_integral_ + (beyond - reach) + change * last * (1 - last / distance);
        }
        const double place = std::sqrt(beyond / reach) * intervals;
        const Piece& piece = pieces_[std::min(static_cast<std::uint32_t>(place), intervals - 1)];
        const double s = (beyond - piece.low) / piece.width;
        return piece.integral + s * (piece.slope + s * (piece.bend + s * piece.twist));
    }

    /// integral_to() without a root and a division, within 1e-6 of it.
    [[nodiscard]] double quick_integral_to(double distance) const noexcept {
        const double place = (distance - start_) * steps_in_radius;
        if (!(place >= 0 && place < quick_steps)) {
            return integral_to(distance);
        }
        const auto i = static_cast<std::int32_t>(place);
        const double s = place - i;
        const std::array<double, 4>& cubic = quick_[static_cast<std::size_t>(i)];
        return cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
    }

 private:
    static constexpr std::int32_t steps_in_radius = 128;
    static constexpr std::int32_t quick_steps = 8 * steps_in_radius;
    static constexpr double reach = 16;  ///< of the table, in radii; farther out k falls like one over the square
    static constexpr std::uint32_t intervals = 1024;

    /// A stretch of the table: the integral is integral + s (slope + s (bend + s twist)) at the share s of its width.
    struct Piece {
        double low, width;  ///< distances beyond the start
        double integral, slope, bend, twist;
    };

    EffectCurve curve_;
    double start_;                              ///< before it k is constant
    double start_factor_;                       ///< value of that constant
    std::vector<Piece> pieces_;                 ///< pieces of the integral from `start_` on, shorter towards it
    double last_integral_ = 0;                  ///< up to the end of the table
    double last_factor_ = 1;                    ///< there
    std::vector<std::array<double, 4>> quick_;  ///< the integral from the start on, by equal steps
};

}  // namespace downwash
