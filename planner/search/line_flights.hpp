#pragma once

#include "downwash/search/edge_flights.hpp"

namespace downwash::planning {

/// Edges that know geometry alone (MP-ARM, thesis C.2): the level vehicle follows its reference exactly, with the power
/// of a hover. Nothing is simulated; bounds, limits of the arm and the margin are kept all along the reference.
class LineFlights final : public EdgeFlights {
 public:
    /// @param task must outlive it
    LineFlights(const SearchTask& task, FlightRules rules);

    std::uint64_t fly(std::span<FlightJob> jobs) override;
    void fly(std::span<FlightChain* const> chains) override;
    /// In the nominal world; lines know no other.
    [[nodiscard]] SegmentFlight fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                          const FlightWorld& in) const override;
    void use_threads(int) override {}
    [[nodiscard]] const FlightRules& rules() const noexcept override { return rules_; }

 private:
    /// @param checked counts states
    [[nodiscard]] SegmentFlight flown(const ReferenceSegment& segment, FlightState& vehicle,
                                      std::uint64_t& checked) const;

    const SearchTask& task_;
    FlightRules rules_;
    double hover_power_w_;
};

/// The level vehicle that follows a reference exactly. @param energy_j spent so far
[[nodiscard]] FlightState following(const FlightModel& model, const ReferencePoint& reference, double energy_j);

/// How many poses along a reference are looked at, so that nothing of the robot moves much farther than `spacing_m`
/// from one to the next.
[[nodiscard]] std::int64_t samples_along(const ReferenceSegment& segment, const SearchTask& task, double spacing_m);

}  // namespace downwash::planning
