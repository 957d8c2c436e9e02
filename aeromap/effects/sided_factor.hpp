#pragma once

#include "downwash/base/lane_math.hpp"

// One template over the lane type: kernels for wide instructions include this.

namespace downwash {

/// The thrust ratio K of a rotor, and the part of it that comes from above. What comes from below is the rest,
/// all - above.
template <class T>
struct SidedFactor {
    T all;    ///< K of all surfaces
    T above;  ///< K of the surfaces above the rotor alone
};

/// K where surfaces take this share of a rotor's induced velocity: from 1 to max_factor; the latter from a share of 1
/// on.
template <class T>
T factor_with_loss(const T& share, double max_factor) {
    return lane::select(share < T(1), lane::clamp(T(1) / (T(1) - share), T(1), T(max_factor)), T(max_factor));
}

/// How fast the effect of each side fades with the tilt of a rotor (docs/model.md 4.7). At a tilt theta a level rotor's
/// K - 1 = x becomes x^2 / (x + loss sin^2 theta). 0: the rotor counts as level.
struct TiltLoss {
    double ground = 0;   ///< >= 0, of surfaces below
    double ceiling = 0;  ///< >= 0, of surfaces above

    [[nodiscard]] bool is_any() const noexcept { return ground > 0 || ceiling > 0; }
    friend bool operator==(const TiltLoss&, const TiltLoss&) = default;
};

/// A rotor that counts as level whatever its tilt.
inline constexpr TiltLoss no_tilt_loss{};

/// Fitted to static measurements over ground at tilts up to 30 degrees (docs/aeromap.md). There are none under a
/// ceiling.
inline constexpr double default_ground_tilt_loss = 0.37;

/// K - 1 of a tilted rotor. It differs by no more than the K - 1 of the level one does: a map that is right to 0.01
/// for level rotors is so for tilted ones.
/// @param change K - 1 of the level rotor   @param loss of the side   @param sin_tilt of the angle between its axis and
/// the vertical
template <class T>
T tilted_change(T change, double loss, T sin_tilt) {
    constexpr double tiny = 1e-300;  // no effect stays none
    const T size = lane::abs(change);
    return change * (size / (size + (T(loss) * (sin_tilt * sin_tilt) + T(tiny))));
}

/// K of a tilted rotor from that of a level one at the same place.
template <class T>
SidedFactor<T> tilted(const SidedFactor<T>& level, const TiltLoss& loss, T sin_tilt) {
    SidedFactor<T> k = level;
    if (loss.ceiling > 0) {
        k.above = T(1) + tilted_change(level.above - T(1), loss.ceiling, sin_tilt);
        k.all = k.all + (k.above - level.above);
    }
    if (loss.ground > 0) {
        const T below = level.all - level.above;
        k.all = k.all - (below - tilted_change(below, loss.ground, sin_tilt));
    }
    return k;
}

}  // namespace downwash
