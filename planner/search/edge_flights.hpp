#pragma once

#include <cstdint>
#include <span>

#include "downwash/search/search_task.hpp"
#include "downwash/simulation/flight_batch.hpp"

namespace downwash::planning {

/// How the edges of a search are flown. This is all in which the levels of awareness differ: an edge of MP-ARM is a
/// line, one of MP-ARM-DA a flight in free air, one of MP-ARM-ADA a flight through the aero map.
template <class Family>
class EdgeFlightsOf {
 public:
    using ReferenceSegment = typename Family::ReferenceSegment;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using FlightChain = typename Family::FlightChain;
    using SegmentFlight = typename Family::SegmentFlight;
    using FlightWorld = typename Family::FlightWorld;

    EdgeFlightsOf() = default;
    virtual ~EdgeFlightsOf() = default;
    EdgeFlightsOf(const EdgeFlightsOf&) = delete;
    EdgeFlightsOf& operator=(const EdgeFlightsOf&) = delete;

    /// Flies jobs, each to its end or to where something rejects it.
    /// @return how many states were checked for collision
    virtual std::uint64_t fly(std::span<FlightJob> jobs) = 0;

    /// Flies chains of jobs in the nominal world to their ends.
    virtual void fly(std::span<FlightChain* const> chains) = 0;

    /// Flies one segment from a vehicle, which is replaced by that at the end; never ended from outside. The same
    /// vehicle comes out as of a job, to the last bit. May be called from any thread.
    [[nodiscard]] virtual SegmentFlight fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                                  const FlightWorld& in = {}) const = 0;

    /// Sets how many threads the next batches use. May be called from any thread.
    virtual void use_threads(int threads) = 0;
};
using EdgeFlights = EdgeFlightsOf<Plane>;

}  // namespace downwash::planning
