#pragma once

#include <optional>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/ompl_planners/reference_steps.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// How a flight ends: a reference segment to rest at the goal, and the hold there.
template <class Family>
struct ClosingOf {
    using Knot = typename decltype(Family::Plan::reference)::value_type;
    using FlightState = typename Family::FlightState;

    Knot goal;            ///< goal at rest, in ticks since the start
    FlightState arrival;  ///< the vehicle before the hold
    FlightState end;      ///< the vehicle after the hold
    double cost = 0;      ///< cost of the whole flight, hold included
};
using Closing = ClosingOf<Plane>;

/// The flights of one problem that planners over controls choose from, flown in closed loop tick by tick, in
/// every world of the search.
template <class Family>
class SteeredFlightsOf {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using SearchSpace = typename Family::SearchSpace;
    using Plan = typename Family::Plan;
    using SearchTask = SearchTaskOf<Family>;
    using ReferenceSteps = ReferenceStepsOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using FleetJob = FleetJobOf<Family>;
    using Fleet = FleetOf<Family>;
    using Closing = ClosingOf<Family>;

    /// @param flights must outlive it
    explicit SteeredFlightsOf(PlannedFlights& flights);

    [[nodiscard]] const SearchTask& task() const noexcept { return task_; }
    [[nodiscard]] const SearchSpace& space() const noexcept { return task_.space; }
    [[nodiscard]] const ReferenceSteps& steps() const noexcept { return steps_; }
    [[nodiscard]] PlannedFlights& flights() const noexcept { return flights_; }

    /// The vehicle at the start of the problem.
    [[nodiscard]] FlightPoint start() const;

    /// Flies one step with the reference taking on a velocity. The tick at which a rule is broken ends the step.
    /// @param velocity wanted along each axis [m/s or rad/s]
    [[nodiscard]] FlightPoint stepped(const FlightPoint& from, const double* velocity) const;

    /// A step that was flown before, flown again: neither counted, nor cut short when the search is over.
    [[nodiscard]] FlightPoint stepped_again(const FlightPoint& from, const double* velocity) const;

    /// Flies a whole reference segment, as our own planner's edges are. Not counted. It is the caller's business that
    /// the segment keeps the limits of motion.
    [[nodiscard]] FlightPoint followed(const FlightPoint& from, const ReferencePoint& to, std::int64_t ticks) const;

    /// Whether a moment is so near the goal that closing is worth a flight.
    [[nodiscard]] bool is_worth_closing(const FlightPoint& point) const;

    /// Flies from a moment to rest at the nearest configuration that meets the goal, and holds there. Nothing when that
    /// is rejected.
    [[nodiscard]] std::optional<Closing> closing(const FlightPoint& from) const;

    /// The plan through these moments, one step apart; with an end where there is one, otherwise braked to rest.
    [[nodiscard]] Plan plan(const std::vector<FlightPoint>& points, const std::optional<Closing>& end) const;

    /// Flies the plan through moments to an end again; see PlannedFlights::verify.
    void verify(const std::vector<FlightPoint>& points, const Closing& end) const;

 private:
    void arrive(FlightPoint& next, const FlightPoint& from, const FleetJob& job) const;
    /// Where a step leads but for its flight: the reference, and the place where that would rest.
    [[nodiscard]] FlightPoint steered(const FlightPoint& from, const double* velocity) const;

    PlannedFlights& flights_;
    const SearchTask& task_;
    ReferenceSteps steps_;
};
using SteeredFlights = SteeredFlightsOf<Plane>;

}  // namespace downwash::planning
