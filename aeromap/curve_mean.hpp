#pragma once

// Private to aeromap.

#include <array>
#include <vector>

#include "downwash/effects/effect_curve.hpp"

namespace downwash {

/// Means of a curve that falls with distance over ranges of distance, from its tabulated integral: what a surface does
/// along a line on which it is a straight slope. Immutable.
class CurveMean {
 public:
    /// @pre curve.falls_with_distance() and not curve.depends_on_wall()
    explicit CurveMean(const EffectCurve& curve);

    /// Mean of k between two distances in radii, in either order; at least 0 and finite. Off by less than 1e-6 up to
    /// `reach` beyond the cap and by less than 1e-4 where a range reaches farther; over less than a thousandth of a
    /// radius k in the middle.
    [[nodiscard]] double operator()(double one, double other) const;

 private:
    /// A stretch of the table: the integral is integral + s (slope + s (bend + s twist)) at the share s of its width.
    struct Piece {
        double low, width;  ///< distances beyond the start
        double integral, slope, bend, twist;
    };
    [[nodiscard]] double integral_to(double distance) const noexcept;

    EffectCurve curve_;
    double start_;               ///< before it k is constant
    double start_factor_;        ///< value of that constant
    std::vector<Piece> pieces_;  ///< pieces of the integral from `start_` on, shorter towards it
    double last_integral_ = 0;   ///< up to the end of the table
    double last_factor_ = 1;     ///< there
};

}  // namespace downwash
