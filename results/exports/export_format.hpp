#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/exports/export_settings.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// One format.
struct ExportFormat {
    std::string_view name;
    std::string_view file_name;  ///< default name of its file in a run's folder
    std::string_view description;
    bool is_to_be_flown = false;  ///< commands for a vehicle
    bool has_rate = false;        ///< made of set-points at ExportSettings::rate_hz
    bool has_origin = false;      ///< needs ExportSettings::origin
    bool has_bearing = false;     ///< asks where north is: ExportSettings::bearing_deg
    bool leaves_out_arm = false;  ///< commands for the vehicle alone
};

/// All formats for a run.
inline constexpr std::array export_formats{
    ExportFormat{.name = "csv",
                 .file_name = "setpoints.csv",
                 .description = "set-points of the plan in the world frame, a row each",
                 .is_to_be_flown = true,
                 .has_rate = true},
    ExportFormat{.name = "ros",
                 .file_name = "trajectory.json",
                 .description = "the same as ROS messages: trajectory_msgs/MultiDOFJointTrajectory of the vehicle and "
                                "trajectory_msgs/JointTrajectory of the arm; with --bearing in a map with x east and y "
                                "north",
                 .is_to_be_flown = true,
                 .has_rate = true,
                 .has_bearing = true},
    ExportFormat{.name = "px4",
                 .file_name = "px4.json",
                 .description = "the same for PX4's offboard mode: px4_msgs/TrajectorySetpoint in its axes (north, "
                                "east, down; yaw from north, -pi to pi), and the arm as in ros",
                 .is_to_be_flown = true,
                 .has_rate = true,
                 .has_bearing = true},
    ExportFormat{
        .name = "px4-csv",
        .file_name = "px4.csv",
        .description = "the same as a table, with the columns that PX4's ulog2csv writes, and the arm as in csv",
        .is_to_be_flown = true,
        .has_rate = true,
        .has_bearing = true},
    ExportFormat{.name = "mavlink",
                 .file_name = "setpoints.tlog",
                 .description = "the same as a log of MAVLink 2: SET_POSITION_TARGET_LOCAL_NED with all its fields; "
                                "without the arm",
                 .is_to_be_flown = true,
                 .has_rate = true,
                 .has_bearing = true,
                 .leaves_out_arm = true},
    ExportFormat{.name = "qgc",
                 .file_name = "mission.plan",
                 .description = "the vehicle's way as a mission for QGroundControl; without the arm",
                 .is_to_be_flown = true,
                 .has_origin = true,
                 .has_bearing = true,
                 .leaves_out_arm = true},
    ExportFormat{.name = "vtp",
                 .file_name = "flight.vtp",
                 .description = "the flight as VTK polydata: the ways of vehicle and end effector with all columns"},
    ExportFormat{.name = "vtp-scene", .file_name = "scene.vtp", .description = "the obstacles as VTK polydata"},
    ExportFormat{.name = "glb", .file_name = "run.glb", .description = "scene and flying vehicle as animated glTF"},
};

/// A run as the bytes of one of export_formats. Equal runs give equal bytes.
/// @throws InputError if the run lacks what the format shows (plan, flight), or a setting is missing or out of range
[[nodiscard]] DOWNWASH_EXPORT std::string exported(const RunRecord& run, const ExportFormat& format,
                                                   const ExportSettings& settings);
/// The same of a run in space.
[[nodiscard]] DOWNWASH_EXPORT std::string exported(const SpaceRunRecord& run, const ExportFormat& format,
                                                   const ExportSettings& settings);

/// What a format leaves out or cannot keep of a run, for those who fly it.
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> export_warnings(const RunRecord& run,
                                                                       const ExportFormat& format);
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> export_warnings(const SpaceRunRecord& run,
                                                                       const ExportFormat& format);

}  // namespace downwash
