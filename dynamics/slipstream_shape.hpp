#pragma once

// Constants of a rotor's slipstream: docs/model.md 2.7. Lengths are in radii of the rotor.

namespace downwash::dynamics {

/// Share of the core that a radius of way mixes away: after six the core is gone.
inline constexpr double mixing_rate = 1.0 / 6.0;
/// Growth of the outer edge over the slipstream's own radius, for each radius of way behind the end of the core.
inline constexpr double jet_spread = 0.301;
/// What an integral over the profile f(e) = (1 - e^1.5)^2 of the mixing layer, 0 <= e <= 1, carries of momentum: f^2
/// de, and 2 f^2 e de.
inline constexpr double layer_momentum = 1 - 4 / 2.5 + 6 / 4.0 - 4 / 5.5 + 1 / 7.0;
inline constexpr double jet_momentum = 2 * (1 / 2.0 - 4 / 3.5 + 6 / 5.0 - 4 / 6.5 + 1 / 8.0);
/// By how much of itself the slipstream slows down while its edge grows by its own radius, behind the end of the core.
inline constexpr double jet_decay = 0.36539907432351754;  // sqrt(jet_momentum)
/// No air moves farther from the axis than edge_radii + edge_spread times the depth below the disc, above it too.
inline constexpr double edge_radii = 1.285;
inline constexpr double edge_spread = 0.2135;
/// Air above the disc moves up to this height.
inline constexpr double inflow_radii = 0.5;

}  // namespace downwash::dynamics
