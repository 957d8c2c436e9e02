#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash {

/// One segment of a flight that is planned, and what came of it.
struct FlightLeg {
    ReferenceSegment segment;
    SegmentFlight flight = {};  ///< as fly() reports it; zero ticks when the leg was not reached
    FlightState end = {};       ///< the vehicle at its end, or where it was refused
};

/// A flight along one or more segments, each beginning where the one before ended.
struct FlightJob {
    FlightState start;
    std::vector<FlightLeg> legs;  ///< at least one
    /// In the last so many ticks of the last leg, the state before the first of them included, the goal has to be met;
    /// otherwise the flight is refused as goal_missed. 0: no goal.
    std::int64_t judged_ticks = 0;

    /// Why the flight ended early.
    [[nodiscard]] DOWNWASH_EXPORT FlightFault fault() const noexcept;
    /// The vehicle at the end of an accepted flight.
    [[nodiscard]] const FlightState& end() const noexcept { return legs.back().end; }
};

/// Instructions that the flights of a batch are computed with. The results are the same to the last bit.
enum class Instructions : std::uint8_t {
    baseline,  ///< what every processor of the architecture has
    avx2,      ///< x86-64 only
};

/// The widest that this build and this processor have.
[[nodiscard]] DOWNWASH_EXPORT Instructions best_instructions() noexcept;

/// Flies jobs side by side in the lanes of wide registers, each exactly as fly() flies its legs one after the other. A
/// lane whose flight ends takes on the next job. Calls from several threads do not disturb each other.
/// @param map,rules as for fly()   @param goal of jobs with judged_ticks; may be nullptr when there are none
/// @pre `instructions` are there
DOWNWASH_EXPORT void fly_batch(const FlightModel& model, const AeroMap* map, const FlightRules& rules, const Goal* goal,
                               std::span<FlightJob> jobs, Instructions instructions = best_instructions());

}  // namespace downwash
