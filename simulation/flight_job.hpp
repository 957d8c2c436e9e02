#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash {

/// One segment of a planned flight, and its outcome.
struct FlightLeg {
    ReferenceSegment segment;
    SegmentFlight flight = {};  ///< as fly() reports it; zero ticks if the flight ended before
    FlightState end = {};       ///< the vehicle at its end, or where it was rejected
};

/// A flight along one or more segments, each beginning where the one before ended.
struct FlightJob {
    FlightState start;
    std::vector<FlightLeg> legs;  ///< one after the other, at least one
    /// The vehicle must meet the goal in this many last ticks of the last leg, and in the state before them. Otherwise
    /// the flight is rejected as goal_missed. 0: no goal.
    std::int64_t judged_ticks = 0;
    /// World of the flight; nullptr: the nominal one. Must outlive the flight.
    const FlownWorld* world = nullptr;
    std::int64_t first_tick = 0;  ///< see FlightWorld
    const Goal* goal = nullptr;   ///< instead of the pool's; must outlive the flight

    /// The leg on which the flight ended early; nullptr when it did not.
    [[nodiscard]] DOWNWASH_EXPORT const FlightLeg* rejected_leg() const noexcept;
    /// Why the flight ended early.
    [[nodiscard]] Rejection rejection() const noexcept {
        return rejected_leg() != nullptr ? rejected_leg()->flight.rejection : Rejection::none;
    }
    /// The vehicle at the end of an accepted flight.
    [[nodiscard]] const FlightState& end() const noexcept { return legs.back().end; }
};

/// Jobs that follow one another, of which each is known only when the one before has ended.
class DOWNWASH_EXPORT FlightChain {
 public:
    FlightChain() = default;
    virtual ~FlightChain() = default;
    FlightChain(const FlightChain&) = delete;
    FlightChain& operator=(const FlightChain&) = delete;

    /// The job to fly now, in the nominal world; nullptr: the chain has ended. Asked at first, and whenever a job has
    /// ended. All threads of a pool may ask, one at a time for one chain and several at once for several chains.
    [[nodiscard]] virtual FlightJob* next() = 0;
};

}  // namespace downwash
