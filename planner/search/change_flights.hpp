#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "downwash/search/flight_point.hpp"
#include "downwash/search/planned_flights.hpp"

namespace downwash::planning {

/// A plan with all that was found out by flying it, hold included.
template <class Family>
struct FlownPlanOf {
    using ReferencePoint = typename Family::ReferencePoint;
    using Fleet = FleetOf<Family>;

    std::vector<ReferencePoint> points;  ///< the first is the start, the last at rest at the goal
    std::vector<Fleet> fleets;           ///< the vehicle in every world at each point, and after the hold
    std::vector<double> costs;           ///< from the start up to each point
    std::vector<double> nominal_costs;   ///< costs up to each point in the nominal world
    std::vector<std::int64_t> ticks;     ///< from each point to the next
    double cost = 0, nominal_cost = 0;   ///< hold included
};
using FlownPlan = FlownPlanOf<Plane>;

/// A changed plan that may be worth flying.
template <class Family>
struct ChangedPlanOf {
    using ReferencePoint = typename Family::ReferencePoint;

    std::vector<ReferencePoint> points;
    std::vector<std::int64_t> ticks;
    std::size_t first = 0, last = 0;  ///< segments that differ from a plan that was flown
};
using ChangedPlan = ChangedPlanOf<Plane>;

/// Changes of one plan that are flown side by side, and what became of them in the nominal world.
template <class Family>
struct ChangeBatchOf {
    using FleetJob = FleetJobOf<Family>;
    using ChangedPlan = ChangedPlanOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;

    std::vector<ChangedPlan> changes;
    std::vector<double> saved;   ///< of each, by ChangeFlights::saved_before_rounding()
    std::vector<FleetJob> jobs;  ///< of the whole plan where the change itself is promising
    FlightStatistics counts;     ///< of drawing and flying them, not yet counted
};
using ChangeBatch = ChangeBatchOf<Plane>;

/// Flies changed plans as far as they are promising: the changed segments in the nominal world, then the rest of the
/// plan with its hold, then all of it in the other worlds.
template <class Family>
class ChangeFlightsOf {
 public:
    using ChangeFlights = ChangeFlightsOf;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using FlightLeg = typename Family::FlightLeg;
    using FlightChain = typename Family::FlightChain;
    using Fleet = FleetOf<Family>;
    using FleetJob = FleetJobOf<Family>;
    using SearchTask = SearchTaskOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using ChangedPlan = ChangedPlanOf<Family>;
    using ChangeBatch = ChangeBatchOf<Family>;
    using FlownPlan = FlownPlanOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;

    /// @param start the moment at which all plans begin   @param flights must outlive it
    ChangeFlightsOf(FlightPoint start, PlannedFlights& flights);

    /// Gives segments `first` to `last` as few ticks as they need, if they may be worth flying. The others keep their
    /// ticks; their numbers may have shifted by a corner more or less.
    [[nodiscard]] std::optional<ChangedPlan> timed(std::vector<ReferencePoint> points,
                                                   const std::vector<std::int64_t>& old_ticks, std::size_t first,
                                                   std::size_t last, FlightStatistics& counts) const;

    /// Plans flown from the start to the end; nothing for those that are rejected.
    [[nodiscard]] std::vector<std::optional<FlownPlan>> flown_whole(const std::vector<ChangedPlan>& plans);

    /// Flies batches in the nominal world, all of them at once if the flights can.
    /// @param bases the plan of which each batch holds changes
    void fly_nominal(std::span<ChangeBatch* const> batches, std::span<const FlownPlan* const> bases);

    /// Flies the promising ones of a batch in the other worlds, the cheapest first, until one is accepted and cheaper
    /// there, too.
    [[nodiscard]] std::optional<FlownPlan> best_of(const FlownPlan& base, ChangeBatch& batch);

    /// What a change saves of the time that its segments need before it is rounded up to ticks [s]. 0 unless ticks are
    /// all that a plan costs: then it tells apart changes of the same cost.
    [[nodiscard]] double saved_before_rounding(const FlownPlan& base, const ChangedPlan& change) const;

 private:
    class Chain;
    void fly_chains(std::span<ChangeBatch* const> batches, std::span<const FlownPlan* const> bases);
    void fly_in_two_steps(ChangeBatch& batch, const FlownPlan& base);
    /// The flight of some segments, those from `first` to `last`, and of the hold after the plan's last one.
    [[nodiscard]] FleetJob job_for(const Fleet& from, const ChangedPlan& change, std::size_t first,
                                   std::size_t last) const;
    /// The cost in the nominal world from the start up to the end of a job with which a change begins.
    [[nodiscard]] double nominal_cost_after(const FlownPlan& base, const ChangedPlan& change,
                                            const FleetJob& job) const;
    /// Whether a job flies a change to the end of its plan.
    [[nodiscard]] static bool is_whole(const ChangedPlan& change, const FleetJob& job);
    [[nodiscard]] bool costs_less(const FlownPlan& base, const ChangedPlan& change, const FleetJob& job,
                                  double saved) const;
    [[nodiscard]] FlownPlan flown(const FlownPlan& base, const ChangedPlan& change, const FleetJob& job) const;

    FlightPoint start_;
    PlannedFlights& flights_;
};
using ChangeFlights = ChangeFlightsOf<Plane>;

}  // namespace downwash::planning
