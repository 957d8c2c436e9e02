#pragma once

// Private: not installed. One function for each row of export_formats().

#include <string>

#include "downwash/exports/export_format.hpp"
#include "downwash/exports/setpoints.hpp"

namespace downwash {

/// The plan's set-points at the rate asked for, hold included. @throws InputError without a plan
[[nodiscard]] std::vector<Setpoint> setpoints_of(const RunRecord& run, const ExportSettings& settings);

[[nodiscard]] std::string setpoint_csv(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string ros_trajectory(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string qgc_plan(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_flight(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string vtk_scene(const RunRecord& run, const ExportSettings& settings);
[[nodiscard]] std::string gltf_binary(const RunRecord& run, const ExportSettings& settings);

}  // namespace downwash
