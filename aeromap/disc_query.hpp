#pragma once

// Private to aeromap.

#include <cstdint>
#include <limits>

#include "downwash/aeromap/curve_mean.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// The side of a rotor on which surfaces are looked for.
enum class Side : std::uint8_t { below, above };

/// A rotor's level disc and what it asks of one side.
struct DiscQuery {
    const Scene& scene;
    Vector3 hub_m;
    double radius_m;  ///< radius of the disc
    Side side;
    const EffectCurve& curve;
    double unit_m;          ///< what the curve's distances are measured in: the rotor radius
    const CurveMean* mean;  ///< mean of the curve; null when it has none

    /// Distance from the rotor plane to a stretch of a vertical line: 0 when the plane cuts it, infinite when the
    /// stretch lies on the other side.
    [[nodiscard]] double gap(double low_m, double high_m) const noexcept {
        const double near = side == Side::below ? hub_m[2] - high_m : low_m - hub_m[2];
        const double far = side == Side::below ? hub_m[2] - low_m : high_m - hub_m[2];
        return near > 0 ? near : (far >= 0 ? 0 : std::numeric_limits<double>::infinity());
    }
    /// The curve's factor at that distance.
    [[nodiscard]] double factor(double gap_m) const { return curve(gap_m / unit_m); }
    /// The distance at which the curve meets its cap, negative when it never does.
    [[nodiscard]] double kink_m() const { return unit_m * curve.cap_distance(); }
};

}  // namespace downwash
