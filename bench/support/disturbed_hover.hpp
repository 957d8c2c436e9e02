#pragma once

#include "../../tests/support/random.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/hover_analysis.hpp"

namespace downwash::bench {

/// How long such a flight takes.
inline constexpr double disturbed_flight_s = 40;

/// How far off a flight begins, and what it must not leave [m, rad].
struct Disturbance {
    double size = 1e-3;
    double leaving = 0.05;
};

/// What comes of a disturbed hover.
struct DisturbedHover {
    /// It left; or in the last quarter of the flight it was farther away than in the one before, or as far (a limit
    /// cycle) and farther than it began.
    bool grew;
    double end_m;  ///< how far away it was in the end: the greatest difference of a coordinate [m, rad]
};

/// Flies disturbed_flight_s with direct aerodynamics from beside a hover.
[[nodiscard]] DisturbedHover fly_disturbed(const FlightModel& model, const HoverTrim& trim,
                                           const Disturbance& disturbance, test::Random& random);

}  // namespace downwash::bench
