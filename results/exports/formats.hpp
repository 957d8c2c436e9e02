#pragma once

// Private: not installed. One function for each row of export_formats.

#include <string>
#include <vector>

#include "downwash/exports/export_settings.hpp"
#include "downwash/exports/setpoints.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// Within this distance of a waypoint, an autopilot begins the next leg of a mission [m].
inline constexpr double acceptance_radius_m = 0.2;

/// The plan of a run that another autopilot can fly. @throws InputError without a plan, or where a touch follows it
[[nodiscard]] const Plan& plan_to_be_flown(const RunRecord& run);

/// When the hover at the last goal ends [s]. @pre run.plan
[[nodiscard]] double end_of_hover_s(const RunRecord& run);

/// The plan's set-points at the rate asked for, hold included. @throws InputError as plan_to_be_flown()
[[nodiscard]] std::vector<Setpoint> setpoints_of(const RunRecord& run, const ExportSettings& settings);

[[nodiscard]] std::string setpoint_csv(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string ros_trajectory(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string qgc_plan(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_flight(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_scene(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string gltf_binary(const RunRecord& run, const ExportSettings& settings);

}  // namespace downwash
