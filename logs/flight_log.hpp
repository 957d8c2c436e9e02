#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/logs/log_series.hpp"

namespace downwash {

/// Formats of flight logs.
enum class LogFormat : std::uint8_t {
    ulog,       ///< PX4
    dataflash,  ///< ArduPilot's binary log
    rosbag,     ///< a ROS 1 bag, format 2.0
    csv,        ///< tables: of ours, of ulog2csv, of pandas and others
};
inline constexpr std::array all_log_formats{LogFormat::ulog, LogFormat::dataflash, LogFormat::rosbag, LogFormat::csv};

/// Name for people: "ULog".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(LogFormat format) noexcept;

/// Axes of the world and of the body in which a log was written.
enum class LogAxes : std::uint8_t {
    up,    ///< x, y, z up, such as ENU; body x forward, y left, z up
    down,  ///< north, east, down; body x forward, y right, z down
};

/// Who said what axes a log has.
enum class AxesSource : std::uint8_t { declared, format, guessed };

/// What the numbers of rotor commands are.
enum class RotorUnit : std::uint8_t {
    newton,        ///< thrust in free air [N]
    share,         ///< of the full command, 0 to 1: PX4's actuator_motors
    microseconds,  ///< pulse width [us]: PX4's actuator_outputs, ArduPilot's RCOU
};

/// What of a log jumps although the vehicle does not.
enum class JumpKind : std::uint8_t {
    position,   ///< x and y
    height,     ///< z
    heading,    ///< the attitude about z
    estimator,  ///< the autopilot flies by another estimator from there on, or all of it was reset
};

/// Name for people and files: "position".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(JumpKind kind) noexcept;

/// A moment at which an estimator was reset: what it tells of the vehicle jumps.
struct LogJump {
    JumpKind kind = JumpKind::position;
    double t_s = 0;       ///< of the first row behind it, as those of series
    Vector3 step_m{};     ///< by which places jump, as far as the log says it; in the world's axes
    double turn_rad = 0;  ///< by which the heading jumps, counterclockwise seen from above
    std::string source;   ///< what tells it: "vehicle_local_position.xy_reset_counter"
};

/// What was recorded in a flight, in SI units and in axes with z up whatever the log has: the world's x and y are those
/// of the log if it has z up; of a log in north, east, down they point north and west. The body's x points forward, y
/// to the left, z up. A log of a flight in a vertical plane has that plane's x, 0 and z as its position.
///
/// Each series has times of its own, in seconds since the log's beginning, and may be empty. What follows from a frame
/// (yaw, a place) is as the log says it: nothing is aligned with a plan here.
struct FlightLog {
    std::vector<std::string> files;  ///< as the user named them
    LogFormat format = LogFormat::csv;
    LogAxes recorded_axes = LogAxes::up;  ///< what the files have, before they were turned
    AxesSource axes_source = AxesSource::format;
    double start_s = 0;     ///< the log's own clock where t_s is 0, such as seconds since boot
    double duration_s = 0;  ///< of the longest series

    LogSeries position_m;    ///< 3: x, y, z in the world
    LogSeries velocity_m_s;  ///< 3: in the world
    LogSeries attitude;      ///< 4: quaternion (w, x, y, z) of length 1 from body to world axes, without jumps of sign
    LogSeries body_rates_rad_s;     ///< 3: in body axes
    LogSeries specific_force_m_s2;  ///< 3: what an accelerometer measures, in body axes; +9.8 upward at rest
    LogSeries joints_rad;           ///< one for each joint of the arm
    LogSeries joint_rates_rad_s;    ///< the same
    LogSeries joint_torques_nm;     ///< the same, of the motors
    LogSeries rotor_commands;       ///< one for each rotor, in the order of the log
    RotorUnit rotor_unit = RotorUnit::newton;
    LogSeries setpoint_m;  ///< 3: position that the autopilot was told to be at, in the world

    std::vector<LogJump> jumps;  ///< at rising times

    std::vector<std::string> remarks;  ///< what was guessed, skipped or left out, as sentences for people
};

/// All series of a log, with their names for people, in their order above.
struct NamedSeries {
    std::string_view name;
    LogSeries FlightLog::*series;
};
inline constexpr std::array named_series{
    NamedSeries{"position", &FlightLog::position_m},
    NamedSeries{"velocity", &FlightLog::velocity_m_s},
    NamedSeries{"attitude", &FlightLog::attitude},
    NamedSeries{"body rates", &FlightLog::body_rates_rad_s},
    NamedSeries{"specific force", &FlightLog::specific_force_m_s2},
    NamedSeries{"joints", &FlightLog::joints_rad},
    NamedSeries{"joint rates", &FlightLog::joint_rates_rad_s},
    NamedSeries{"joint torques", &FlightLog::joint_torques_nm},
    NamedSeries{"rotor commands", &FlightLog::rotor_commands},
    NamedSeries{"set-points", &FlightLog::setpoint_m},
};

/// Turns what is recorded with z down into the axes of FlightLog, or back: the world's y and z and the body's y and z
/// change their signs.
DOWNWASH_EXPORT void turn_over(FlightLog& log);

/// Brings a log whose series are filled, with times of the log's own clock, into its form: the earliest time becomes 0,
/// quaternions get length 1 and no jumps of sign, the axes z up. Series with a quaternion of no length lose that row.
DOWNWASH_EXPORT void finish(FlightLog& log);

}  // namespace downwash
