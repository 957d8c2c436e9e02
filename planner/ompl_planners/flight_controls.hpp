#pragma once

#include <ompl/base/Goal.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/SpaceInformation.h>

#include <vector>

#include "downwash/ompl_planners/steered_flights.hpp"
#include "downwash/search/flight_space.hpp"

// Steered flights as OMPL's planners over controls see them: controls are reference velocities held over whole steps.

namespace downwash::planning {

/// Longest time for which a planner holds a control, in steps.
inline constexpr unsigned int max_control_steps = 8;

/// State space, control space, samplers, validity and propagation. The arguments must outlive it.
template <class Family>
[[nodiscard]] ompl::control::SpaceInformationPtr make_flight_information(const SteeredFlightsOf<Family>& flights,
                                                                         Random& random);

/// The goal: moments from which a flight can close. isSatisfied() flies.
template <class Family>
[[nodiscard]] ompl::base::GoalPtr make_closing_goal(const ompl::control::SpaceInformationPtr& information,
                                                    const SteeredFlightsOf<Family>& flights, Random& random);

/// Makes a control of that space, in the plane, ask for a whole reference segment instead: from the moment at which it
/// begins to `to`, in a single step whatever its length. So our planner's edges are controls too.
void follow(ompl::control::Control* control, const ReferencePoint& to, std::int64_t ticks);

/// The reference velocity that a control of that space asks for, along each axis [m/s or rad/s].
[[nodiscard]] const double* velocity_of(const ompl::control::Control* control);

/// Every moment of a path, one step or reference segment apart, simulated once more: OMPL keeps only those at which the
/// control changes.
/// @throws std::logic_error when a moment does not come out bit for bit
template <class Family>
[[nodiscard]] std::vector<FlightPointOf<Family>> moments_along(const ompl::control::PathControl& path,
                                                               const SteeredFlightsOf<Family>& flights);

}  // namespace downwash::planning
