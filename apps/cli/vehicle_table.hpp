#pragma once

#include <functional>
#include <string>
#include <vector>

#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// The divisor of a pitch torque for its factor [Nm].
[[nodiscard]] double weight_times_radius_nm(const FlightModel& model);

/// The effect of surfaces on the whole vehicle, as CSV: a row for every pitch and place of the centre of mass in the
/// bounds, x running fastest and pitch slowest. Where the vehicle is not flyable the factors are empty.
/// @param step_m maximum distance between places, > 0   @param on_progress see run_parallel
/// @throws UsageError for a step that makes too many rows
[[nodiscard]] std::string vehicle_table(const Problem& problem, const FlightModel& model,
                                        const std::vector<double>& pitch_deg, double step_m, int threads,
                                        const std::function<void(double)>& on_progress = {});

}  // namespace downwash::cli
