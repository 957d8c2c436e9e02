#pragma once

#include <ompl/base/Goal.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/control/SpaceInformation.h>

#include "downwash/rivals/steered_flights.hpp"
#include "downwash/search/random.hpp"

// Steered flights as OMPL's planners over controls see them: states are moments of a flight, controls reference
// velocities held over whole steps. Every random number comes from the caller's generator.

namespace downwash::planning {

/// Longest time for which a planner holds a control, in steps.
inline constexpr unsigned int most_control_steps = 8;

/// State space, control space, samplers, validity and propagation. Distances are those between the places where the
/// references would come to rest, so speed counts without a weight to be chosen. The arguments must outlive it.
[[nodiscard]] ompl::control::SpaceInformationPtr make_flight_information(const SteeredFlights& flights, Random& random);

/// The goal: moments from which a flight can close. Asking whether one is satisfied flies.
[[nodiscard]] ompl::base::GoalPtr make_flight_goal(const ompl::control::SpaceInformationPtr& information,
                                                   const SteeredFlights& flights, Random& random);

/// The problem's objective: what the flight between two moments has cost. Any solution is good enough to be reported.
[[nodiscard]] ompl::base::OptimizationObjectivePtr make_flight_objective(
    const ompl::control::SpaceInformationPtr& information);

/// Whether vehicle and reference are the same to the last bit.
[[nodiscard]] bool is_same_moment(const FlightPoint& a, const FlightPoint& b);

/// The moment that a state of that space holds.
[[nodiscard]] FlightPoint& point_of(ompl::base::State* state);
[[nodiscard]] const FlightPoint& point_of(const ompl::base::State* state);

/// The reference velocity that a control of that space asks for: (x, z, arm) [m/s, m/s, rad/s].
[[nodiscard]] const double* velocity_of(const ompl::control::Control* control);

}  // namespace downwash::planning
