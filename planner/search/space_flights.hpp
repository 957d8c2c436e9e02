#pragma once

#include <memory>
#include <mutex>

#include "downwash/search/edge_flights.hpp"
#include "downwash/simulation/space_pool.hpp"

namespace downwash::planning {

/// Edges that are closed-loop flights in space, in free air (MP-ARM-DA) or among surfaces (MP-ARM-ADA). See
/// ClosedLoopFlights.
class SpaceFlights final : public EdgeFlightsOf<Space> {
 public:
    /// @param task must outlive it
    /// @param rules of planned flights; empty: those of every flight, and a margin of 0
    /// @param is_over asked now and then, by all threads; true ends flights without a result
    /// @param threads at least 1; nothing but the time depends on it
    SpaceFlights(const SearchTaskOf<Space>& task, std::optional<SpacePlanningRules> rules,
                 std::function<bool()> is_over, int threads);

    std::uint64_t fly(std::span<SpaceFlightJob> jobs) override;
    void fly(std::span<SpaceFlightChain* const> chains) override { pool_.fly(chains); }
    /// With the narrowest registers, one flight at a time.
    [[nodiscard]] SpaceSegmentFlight fly_again(const SpaceSegment& segment, AnySpaceState& vehicle,
                                               const SpaceFlightWorld& in) const override;
    void use_threads(int threads) override { pool_.use_threads(threads); }

 private:
    SpacePool pool_;
    mutable std::mutex mutex_;
    std::unique_ptr<SpacePool> again_;
};

}  // namespace downwash::planning
