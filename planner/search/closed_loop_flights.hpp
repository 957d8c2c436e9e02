#pragma once

#include "downwash/search/edge_flights.hpp"
#include "downwash/simulation/flight_batch.hpp"

namespace downwash::planning {

/// Edges that are closed-loop flights, in free air (MP-ARM-DA) or through the aero map (MP-ARM-ADA).
class ClosedLoopFlights final : public EdgeFlights {
 public:
    /// @param task must outlive it   @param threads at least 1; nothing but the time depends on it
    ClosedLoopFlights(const SearchTask& task, FlightRules rules, int threads);

    std::uint64_t fly(std::span<FlightJob> jobs) override;
    void fly(std::span<FlightChain* const> chains) override;
    [[nodiscard]] SegmentFlight fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                          const FlightWorld& in) const override;
    void use_threads(int threads) override { pool_.use_threads(threads); }

 private:
    const SearchTask& task_;
    FlightPool pool_;
};

}  // namespace downwash::planning
