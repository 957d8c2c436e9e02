#pragma once

// Private: not installed.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/exports/run_in_world.hpp"
#include "downwash/exports/setpoint_axes.hpp"

namespace downwash {

/// A column of a table of set-points.
struct SetpointColumn {
    std::string name;
    std::function<double&(Setpoint&)> number;  ///< of a set-point that has all joints
};

/// How a table of comma-separated text holds set-points.
struct SetpointTable {
    std::string_view format;  ///< its name in export_formats
    SetpointFrame frame = SetpointFrame::world;
    std::string_view time;      ///< name of the first column
    bool is_in_us = false;      ///< whether times are whole microseconds, not seconds
    bool has_yaw_rate = false;  ///< otherwise yaw stays as it is
    bool has_yaw_acceleration = false;
    std::vector<SetpointColumn> vehicle = {};
    std::vector<SetpointColumn> jerk = {};  ///< behind those of the vehicle; not needed to read a file
    std::vector<SetpointColumn> arm = {};   ///< behind all others; files of other programs may have none
};

/// The tables `csv` and `px4-csv`. The second has the columns that PX4's ulog2csv writes of the message
/// trajectory_setpoint, and the arm. @param turns whether yaw is an axis of the plan
[[nodiscard]] SetpointTable world_table(const std::vector<JointInWorld>& joints, bool turns);
[[nodiscard]] SetpointTable px4_table(const std::vector<JointInWorld>& joints);

}  // namespace downwash
