#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/StateSpace.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include "downwash/search/flight_point.hpp"
#include "downwash/search/random.hpp"

// Flights as OMPL sees them: a state is a moment of a flight. Every random number comes from the caller's generator.

namespace downwash::planning {

/// The space of all moments of flights of one task. Distances are those between the places where the references come to
/// rest, so speed counts without a weight to be chosen. Task and generator must outlive it.
template <class Family>
[[nodiscard]] ompl::base::StateSpacePtr make_flight_space(const SearchTaskOf<Family>& task, Random& random);

/// The moment that a state of that space holds.
template <class Family = Plane>
[[nodiscard]] FlightPointOf<Family>& point_of(ompl::base::State* state);
/// The moment that a state of that space holds, to read.
template <class Family = Plane>
[[nodiscard]] const FlightPointOf<Family>& point_of(const ompl::base::State* state);

/// The generator of such a space of the plane, from which its samplers draw.
[[nodiscard]] Random& random_of(const ompl::base::StateSpace& flights);
/// The space of configurations that such a space of the plane samples places in.
[[nodiscard]] const ompl::base::StateSpacePtr& places_of(const ompl::base::StateSpace& flights);

/// A moment is valid if the edge to it was not rejected.
template <class Family = Plane>
[[nodiscard]] ompl::base::StateValidityCheckerPtr make_flight_validity(
    const ompl::base::SpaceInformationPtr& information);

/// The task's objective: what the flight between two moments has cost. Any solution is good enough to be reported.
template <class Family = Plane>
[[nodiscard]] ompl::base::OptimizationObjectivePtr make_flight_objective(
    const ompl::base::SpaceInformationPtr& information);

/// Whether an objective is such a one of the plane.
[[nodiscard]] bool is_flight_objective(const ompl::base::OptimizationObjective& objective);

/// The task's goal. Satisfied by a moment at rest within the goal region.
template <class Family>
class FlightGoalOf : public ompl::base::GoalSampleableRegion {
 public:
    using SearchTask = SearchTaskOf<Family>;

    FlightGoalOf(const ompl::base::SpaceInformationPtr& information, const SearchTask& task, Random& random);

    [[nodiscard]] const SearchTask& task() const noexcept { return task_; }

    double distanceGoal(const ompl::base::State* state) const override;
    bool isSatisfied(const ompl::base::State* state) const override;
    bool isSatisfied(const ompl::base::State* state, double* distance) const override;
    /// A moment of rest; anywhere when no place at the goal is found.
    void sampleGoal(ompl::base::State* state) const override;
    unsigned int maxSampleCount() const override;

 private:
    const SearchTask& task_;
    Random& random_;
};
using FlightGoal = FlightGoalOf<Plane>;

/// A task as OMPL's planners get it, without controls: the space, and a definition with start, goal and objective.
struct OmplTask {
    /// Task and generator must outlive it.
    OmplTask(const SearchTask& task, Random& random);

    ompl::base::SpaceInformationPtr information;
    ompl::base::ProblemDefinitionPtr definition;
};

}  // namespace downwash::planning
