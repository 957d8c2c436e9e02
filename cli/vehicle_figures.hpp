#pragma once

#include "downwash/problems/problem.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// The vehicle's force factor at a pitch over where its centre of mass is.
/// @param model outlives the figure, as for all of these
[[nodiscard]] FieldFigure force_figure(const Problem& problem, const FlightModel& model, const Bounds& extent,
                                       double pitch_rad);

/// The parasitic pitch torque [Nm] on the vehicle; below the title, what it is divided by for its factor.
[[nodiscard]] FieldFigure torque_figure(const Problem& problem, const FlightModel& model, const Bounds& extent,
                                        double pitch_rad);

/// Where the vehicle can hover with its arm at an angle, with the boundary of stability.
/// @param threads at least 1
[[nodiscard]] FieldFigure hold_figure(const Problem& problem, const FlightModel& model, const Bounds& extent,
                                      double arm_rad, int threads);

}  // namespace downwash::cli
