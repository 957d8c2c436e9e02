#pragma once

#include <cstdint>
#include <limits>

#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/flight_sums.hpp"

namespace downwash {

/// The outcome of a flight along one segment.
struct SegmentFlight : FlightSums {
    Rejection rejection = Rejection::none;
    std::int64_t ticks = 0;         ///< simulated, the rejected one included
    double clearance_integral = 0;  ///< integral of clearance_density() over time [s/m], when measured
    /// Least clearance on control ticks, when wanted [m]: exact in fly(); in a FlightPool to the error in the rules,
    /// from the beginning of the job on.
    double min_clearance_m = std::numeric_limits<double>::infinity();
};

/// Flies one reference segment in closed loop and rejects it at the first tick that breaks a rule.
/// @param map surface effects while planning; nullptr: no surface effects and no flyable area
/// @param state vehicle at the beginning, replaced by the vehicle at the end, or where the flight was rejected
[[nodiscard]] DOWNWASH_EXPORT SegmentFlight fly(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                                                const ReferenceSegment& segment, FlightState& state,
                                                const FlightWorld& in = {});

/// Distance of the vehicle from its reference in (x, z) [m].
[[nodiscard]] DOWNWASH_EXPORT double tracking_error_m(const FlightState& state, const ReferencePoint& reference);

/// Whether the numbers are finite and the vehicle neither tumbles nor runs away from its reference.
[[nodiscard]] DOWNWASH_EXPORT bool is_stable(const FlightState& state, const ReferencePoint& reference);

}  // namespace downwash
