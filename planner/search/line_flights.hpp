#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <type_traits>

#include "downwash/search/edge_flights.hpp"

namespace downwash::planning {

/// Edges that know geometry alone (MP-ARM, thesis C.2): the level vehicle follows its reference exactly, with the power
/// of a hover. Nothing is simulated; bounds, limits of the arm and the margin are kept all along the reference.
template <class Family>
class LineFlightsOf final : public EdgeFlightsOf<Family> {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using FlightLeg = typename Family::FlightLeg;
    using FlightChain = typename Family::FlightChain;
    using SegmentFlight = typename Family::SegmentFlight;
    using FlightWorld = typename Family::FlightWorld;
    using SearchSpace = typename Family::SearchSpace;
    using Goal = typename Family::Goal;
    using SearchTask = SearchTaskOf<Family>;

    /// @param task must outlive it
    LineFlightsOf(const SearchTask& task, FlightRules rules);

    std::uint64_t fly(std::span<FlightJob> jobs) override;
    void fly(std::span<FlightChain* const> chains) override;
    /// In the nominal world; lines know no other.
    [[nodiscard]] SegmentFlight fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                          const FlightWorld& in) const override;
    void use_threads(int) override {}

 private:
    /// @param checked counts states
    [[nodiscard]] SegmentFlight flown(const ReferenceSegment& segment, FlightState& vehicle,
                                      std::uint64_t& checked) const;

    const SearchTask& task_;
    FlightRules rules_;
    double hover_power_w_;
};
using LineFlights = LineFlightsOf<Plane>;

/// The level vehicle that follows a reference exactly. @param energy_j spent so far
[[nodiscard]] FlightState following(const FlightModel& model, const ReferencePoint& reference, double energy_j);
[[nodiscard]] AnySpaceState following(const SpaceProblemModel& model, const SpacePoint& reference, double energy_j);

/// How many poses along a reference are looked at, so that nothing of the robot moves much farther than `spacing_m`
/// from one to the next.
template <class Segment, class SearchSpace>
[[nodiscard]] std::int64_t samples_along(const Segment& segment, const SearchSpace& space, double spacing_m) {
    const auto& a = segment.from();
    const auto& b = segment.to();
    const auto weighted = [axes = space.axes()](const double* v) {
        double sum_m = 0;
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            sum_m += axes[axis].reach_m * std::abs(v[axis]);
        }
        return sum_m;
    };
    double step[std::extent_v<std::remove_reference_t<decltype(b.position)>>];
    std::transform(std::begin(b.position), std::end(b.position), a.position, step, std::minus{});
    // Ends that move may lead beyond the line between them.
    const double motion_m = weighted(step) + (weighted(a.velocity) + weighted(b.velocity)) * segment.duration_s();
    return static_cast<std::int64_t>(std::ceil(motion_m / spacing_m)) + 1;
}

}  // namespace downwash::planning
