#pragma once

// Private: not installed.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/line_errors.hpp"
#include "downwash/exports/run_in_world.hpp"
#include "downwash/exports/setpoint_axes.hpp"

namespace downwash {

/// Set-points as a file has them.
struct SetpointFile {
    std::string_view format;  ///< its name in export_formats
    SetpointFrame frame = SetpointFrame::world;
    bool has_yaw_rate = true;
    bool has_yaw_acceleration = false;
    bool has_arm = false;               ///< all joints, or none
    std::vector<Setpoint> points = {};  ///< in that frame; times rise from 0
    /// Adds an error or finding at a set-point. It refers to the text.
    std::function<void(LineErrors& errors, std::size_t point, const std::string& message)> add = {};
};

/// Reads set-points in one of the formats that are flown, whichever the text looks like.
/// @param text outlives what is returned   @param file named in messages   @param joints of the robot's arm
/// @throws InputError with the place of every error (twenty at most): another format, what is missing or no finite
/// number, times that do not rise
[[nodiscard]] SetpointFile read_setpoint_file(std::string_view text, const std::string& file,
                                              const std::vector<JointInWorld>& joints, bool turns);

/// @throws InputError with the place of every time (twenty at most) that is not after the one before; without
/// set-points
void require_rising_times(const SetpointFile& setpoints, const std::string& file);

// One function for each kind of file. They leave times as they are.

[[nodiscard]] SetpointFile read_setpoint_table(std::string_view text, const std::string& file,
                                               const std::vector<JointInWorld>& joints, bool turns);
[[nodiscard]] SetpointFile read_setpoint_messages(std::string_view text, const std::string& file,
                                                  const std::vector<JointInWorld>& joints);
/// Whether bytes begin like those of a log of MAVLink: a time, then a frame.
[[nodiscard]] bool is_mavlink_log(std::string_view bytes);
[[nodiscard]] SetpointFile read_mavlink_log(std::string_view bytes, const std::string& file);

}  // namespace downwash
