#pragma once

#include <memory>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// A problem without errors, and the robot and scene of it bound together: made once and handed on.
struct PlannableProblem {
    Problem problem;
    std::shared_ptr<const FlightModel> model;
};

/// Checks a problem. @throws InputError with every error when it cannot be planned
[[nodiscard]] DOWNWASH_EXPORT PlannableProblem plannable(Problem problem);

/// The robot and scene of a problem, bound together.
/// @pre problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const FlightModel> make_flight_model(const Problem& problem);

/// The vehicle at the start of a problem.
/// @pre rotor thrusts and memory, if given, are as many as the robot has
[[nodiscard]] DOWNWASH_EXPORT FlightState start_state(const FlightModel& model, const Start& start);

/// A vehicle in the middle of a flight, as a start. What it saw a delay ago is not part of it: at a start it has always
/// been as it is.
/// @param reference that it follows at this moment
[[nodiscard]] DOWNWASH_EXPORT Start start_of(const FlightModel& model, const FlightState& state,
                                             const ReferencePoint& reference);

}  // namespace downwash
