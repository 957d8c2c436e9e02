#pragma once

#include <vector>

#include "downwash/report/curve_figure.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// The snapshot diagram of a run, as in figures C.6 and C.7 of the thesis: executed and planned vehicle and arm at
/// equal intervals of time, over the scene and the thrust ratio K of its first rotor.
/// @param model of run.problem; the figure is valid while it exists
/// @throws InputError when nothing was flown
[[nodiscard]] DOWNWASH_EXPORT FieldFigure snapshot_figure(const RunRecord& run, const FlightModel& model);

/// Diagrams over time, one below the other: tracking error, pitch and arm, rotor commands, aero factors,
/// clearance, power. @throws InputError when nothing was flown
[[nodiscard]] DOWNWASH_EXPORT std::vector<CurveFigure> time_figures(const RunRecord& run);

}  // namespace downwash
