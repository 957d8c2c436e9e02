#pragma once

#include "downwash/controllers/reference_segment.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// Power of the level, hovering vehicle far from all surfaces, arm still [W].
[[nodiscard]] double hover_power_w(const FlightModel& model);
/// The same of a robot in space, its arm as at the start of the problem.
[[nodiscard]] double hover_power_w(const SpaceProblemModel& model);

/// What a motion costs far from all surfaces, without flying it: the cost of straight edges of OMPL's planners, and the
/// estimate by which our tree decides what is worth flying.
template <class Family>
class FreeAirCostOf {
 public:
    using Configuration = typename Family::Configuration;
    using MotionLimits = typename Family::MotionLimits;
    using SearchSpace = typename Family::SearchSpace;
    using Goal = typename Family::Goal;
    using FlightModel = typename Family::FlightModel;
    using SearchTask = SearchTaskOf<Family>;

    /// @param task must outlive it
    explicit FreeAirCostOf(const SearchTask& task);

    /// Along the rest-to-rest reference between two configurations, the arm by the shorter turn.
    [[nodiscard]] double of_motion(const Configuration& from, const Configuration& to) const;

    /// No chain of rest-to-rest motions between two configurations costs less than this.
    [[nodiscard]] double min_cost_of_motion(const Configuration& from, const Configuration& to) const;

    /// No chain of motions from a configuration to one that meets the goal, with the hold there, costs less than this.
    [[nodiscard]] double min_cost_to_goal(const Configuration& from) const;

    /// The cost of a hold at a configuration. @param hold_s its length [s]
    [[nodiscard]] double of_hold(const Configuration& at, double hold_s) const;

 private:
    [[nodiscard]] double clearance_density(const Configuration& at) const;
    [[nodiscard]] double mean_clearance_density(const Configuration& from, const Configuration& to) const;

    CostFunction objective_;
    bool counts_clearance_;  ///< it takes queries of distance
    const FlightModel& model_;
    const SearchSpace& space_;
    MotionLimits limits_;
    double hover_power_w_;
};
using FreeAirCost = FreeAirCostOf<Plane>;

}  // namespace downwash::planning
