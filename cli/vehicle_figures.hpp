#pragma once

#include "downwash/planner/problem.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// The level vehicle's force factor over where its centre of mass is.
/// @param model outlives the figure, as for all of these
[[nodiscard]] FieldFigure force_figure(const Problem& problem, const FlightModel& model, const MapExtent& extent);

/// The parasitic pitch torque [Nm] on the level vehicle.
[[nodiscard]] FieldFigure torque_figure(const Problem& problem, const FlightModel& model, const MapExtent& extent);

/// Where the vehicle can hover with its arm at an angle, with the boundary of stability.
/// @param threads at least 1
[[nodiscard]] FieldFigure hold_figure(const Problem& problem, const FlightModel& model, const MapExtent& extent,
                                      double arm_rad, int threads);

}  // namespace downwash::cli
