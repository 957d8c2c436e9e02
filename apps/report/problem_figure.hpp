#pragma once

#include "downwash/problems/problem.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// A problem before it is planned: scene, bounds, goals, and the robot at its start, over the thrust ratio K of its
/// first rotor.
/// @param model of the problem; the figure is valid while it exists
[[nodiscard]] DOWNWASH_EXPORT FieldFigure problem_figure(const Problem& problem, const FlightModel& model);

}  // namespace downwash
