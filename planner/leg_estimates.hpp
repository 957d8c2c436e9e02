#pragma once

#include <memory>
#include <span>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/order_search.hpp"
#include "downwash/search/free_air_cost.hpp"

namespace downwash::planning {

/// What the way to a goal costs before anything is flown.
template <class Family>
class LegBoundsOf {
 public:
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using Configuration = typename Family::Configuration;
    using FlightModel = typename Family::FlightModel;
    using SearchSpace = typename Family::SearchSpace;

    /// @param problem in which it is one of the goals   @param model of that problem, must outlive it
    LegBoundsOf(const Problem& problem, const Goal& goal, const FlightModel& model);

    /// A lower bound: straight motion in free air to the goal region, and the hold there.
    [[nodiscard]] LegCost from(const Configuration& at) const;
    /// Straight motions in free air that rest at each of some configurations, and the hold at the last one.
    /// @param chain not empty
    [[nodiscard]] LegCost along(std::span<const Configuration> chain, double hold_s) const;

    /// The space of a search for that goal.
    [[nodiscard]] const SearchSpace& space() const noexcept { return task_.space; }

 private:
    LegBoundsOf(Problem problem, const FlightModel& model);

    Problem problem_, energy_problem_;
    SearchTaskOf<Family> task_, energy_task_;
    FreeAirCostOf<Family> cost_, energy_;
};

/// A leg as it is likely to be flown.
template <class Family>
struct ExpectedLegOf {
    LegCost cost;                                         ///< infinite where no way is known
    std::vector<typename Family::Configuration> corners;  ///< as of SolveOptions::known_way
};

/// What legs take on the shortest ways of the level vehicle around obstacles (WaysAround), from rest to rest at every
/// corner. Not a lower bound, but much nearer to what flights take than straight motion in free air.
/// @param bounds of the way to each place, the one to return to last   @param targets how many of them are no such
/// place
/// @return for each begin, the start last, in turn the legs to all places: rows of targets + 1; nothing if it is over
/// before all are known
[[nodiscard]] std::vector<ExpectedLegOf<Space>> expected_legs(
    const SpaceProblem& problem, std::span<const std::unique_ptr<LegBoundsOf<Space>>> bounds, std::size_t targets,
    const StopCondition& is_over);

/// Nothing: in the plane lower bounds have to do.
[[nodiscard]] inline std::vector<ExpectedLegOf<Plane>> expected_legs(
    const Problem& /*problem*/, std::span<const std::unique_ptr<LegBoundsOf<Plane>>> /*bounds*/,
    std::size_t /*targets*/, const StopCondition& /*is_over*/) {
    return {};
}

}  // namespace downwash::planning
