#pragma once

// Private: not installed. One function for each row of export_formats.

#include <string>
#include <vector>

#include "downwash/exports/export_settings.hpp"
#include "downwash/exports/run_in_world.hpp"
#include "downwash/exports/setpoints.hpp"

namespace downwash {

/// Within this distance of a waypoint, an autopilot begins the next leg of a mission [m].
inline constexpr double acceptance_radius_m = 0.2;

inline constexpr double max_bearing_deg = 360;

/// The plan of a run that another autopilot can fly. @throws InputError without a plan, or where a touch follows it
[[nodiscard]] const WayInWorld& plan_to_be_flown(const RunInWorld& run);

/// The plan's set-points at the rate asked for, hold included. @throws InputError as plan_to_be_flown()
[[nodiscard]] std::vector<Setpoint> setpoints_of(const RunInWorld& run, const ExportSettings& settings);

[[nodiscard]] std::string setpoint_csv(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string ros_trajectory(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string px4_setpoints(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string qgc_plan(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_flight(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_scene(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string gltf_binary(const RunInWorld& run, const ExportSettings& settings);

}  // namespace downwash
