#pragma once

// Private: not installed. One function for each row of export_formats.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/exports/export_settings.hpp"
#include "downwash/exports/run_in_world.hpp"
#include "downwash/exports/setpoint_axes.hpp"
#include "downwash/exports/setpoints.hpp"

namespace downwash {

/// Within this distance of a waypoint, an autopilot begins the next leg of a mission [m].
inline constexpr double acceptance_radius_m = 0.2;

/// The frame_id of messages in SetpointFrame::east_north_up (REP 105).
inline constexpr std::string_view map_frame_id = "map";

/// The plan of a run that another autopilot can fly. @throws InputError without a plan, or where a touch follows it
[[nodiscard]] const WayInWorld& plan_to_be_flown(const RunInWorld& run);

/// A time as messages of PX4 have it [us].
[[nodiscard]] std::int64_t whole_us(double t_s);

/// The plan's set-points in a frame at the rate asked for, hold included. @throws InputError as plan_to_be_flown()
[[nodiscard]] std::vector<Setpoint> setpoints_of(const RunInWorld& run, const ExportSettings& settings,
                                                 SetpointFrame frame);

[[nodiscard]] std::string setpoint_csv(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string ros_trajectory(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string px4_setpoints(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string px4_csv(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string mavlink_log(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string qgc_plan(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_flight(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_scene(const RunInWorld& run, const ExportSettings& settings);
[[nodiscard]] std::string gltf_binary(const RunInWorld& run, const ExportSettings& settings);

}  // namespace downwash
