#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>

#include "downwash/mavlink/message.hpp"

// Messages of MAVLink's dialect "common" (https://mavlink.io/en/messages/common.html). The local frame counts north,
// east and down [m]; angles are in radians. Members that a message leaves at their defaults are zero on the wire.

namespace downwash::mavlink {

/// "Here I am": both sides send it once a second.
struct Heartbeat {
    static constexpr std::uint32_t id = 0;
    static constexpr std::string_view name = "HEARTBEAT";

    std::uint32_t custom_mode = 0;   ///< flight mode; of PX4 see px4_mode()
    std::uint8_t type = 0;           ///< MAV_TYPE
    std::uint8_t autopilot = 0;      ///< MAV_AUTOPILOT
    std::uint8_t base_mode = 0;      ///< MAV_MODE_FLAG, a set of bits
    std::uint8_t system_status = 0;  ///< MAV_STATE
    std::uint8_t mavlink_version = 3;

    static constexpr auto fields() {
        return std::tuple(field("custom_mode", &Heartbeat::custom_mode), field("type", &Heartbeat::type),
                          field("autopilot", &Heartbeat::autopilot), field("base_mode", &Heartbeat::base_mode),
                          field("system_status", &Heartbeat::system_status),
                          field("mavlink_version", &Heartbeat::mavlink_version));
    }
};

/// How a vehicle is turned, and how fast it turns [rad, rad/s].
struct Attitude {
    static constexpr std::uint32_t id = 30;
    static constexpr std::string_view name = "ATTITUDE";

    std::uint32_t time_boot_ms = 0;
    float roll = 0, pitch = 0, yaw = 0;
    float rollspeed = 0, pitchspeed = 0, yawspeed = 0;

    static constexpr auto fields() {
        return std::tuple(field("time_boot_ms", &Attitude::time_boot_ms), field("roll", &Attitude::roll),
                          field("pitch", &Attitude::pitch), field("yaw", &Attitude::yaw),
                          field("rollspeed", &Attitude::rollspeed), field("pitchspeed", &Attitude::pitchspeed),
                          field("yawspeed", &Attitude::yawspeed));
    }
};

/// Where a vehicle is and how it moves, in the local frame [m, m/s].
struct LocalPositionNed {
    static constexpr std::uint32_t id = 32;
    static constexpr std::string_view name = "LOCAL_POSITION_NED";

    std::uint32_t time_boot_ms = 0;
    float x = 0, y = 0, z = 0;
    float vx = 0, vy = 0, vz = 0;

    static constexpr auto fields() {
        return std::tuple(field("time_boot_ms", &LocalPositionNed::time_boot_ms), field("x", &LocalPositionNed::x),
                          field("y", &LocalPositionNed::y), field("z", &LocalPositionNed::z),
                          field("vx", &LocalPositionNed::vx), field("vy", &LocalPositionNed::vy),
                          field("vz", &LocalPositionNed::vz));
    }
};

/// Where a vehicle shall be and how it shall move, in the local frame [m, m/s, m/s2].
struct SetPositionTargetLocalNed {
    static constexpr std::uint32_t id = 84;
    static constexpr std::string_view name = "SET_POSITION_TARGET_LOCAL_NED";

    /// Bits of type_mask: what the vehicle does not follow.
    static constexpr std::uint16_t ignores_position = 0b111, ignores_velocity = 0b111'000,
                                   ignores_acceleration = 0b111'000'000, is_force = 1U << 9U, ignores_yaw = 1U << 10U,
                                   ignores_yaw_rate = 1U << 11U;

    std::uint32_t time_boot_ms = 0;
    float x = 0, y = 0, z = 0;
    float vx = 0, vy = 0, vz = 0;
    float afx = 0, afy = 0, afz = 0;
    float yaw = 0;       ///< clockwise from north as seen from above, -pi to pi
    float yaw_rate = 0;  ///< [rad/s]
    std::uint16_t type_mask = 0;
    std::uint8_t target_system = 0, target_component = 0;
    std::uint8_t coordinate_frame = 1;  ///< MAV_FRAME; 1: local NED

    static constexpr auto fields() {
        using Own = SetPositionTargetLocalNed;
        return std::tuple(field("time_boot_ms", &Own::time_boot_ms), field("x", &Own::x), field("y", &Own::y),
                          field("z", &Own::z), field("vx", &Own::vx), field("vy", &Own::vy), field("vz", &Own::vz),
                          field("afx", &Own::afx), field("afy", &Own::afy), field("afz", &Own::afz),
                          field("yaw", &Own::yaw), field("yaw_rate", &Own::yaw_rate),
                          field("type_mask", &Own::type_mask), field("target_system", &Own::target_system),
                          field("target_component", &Own::target_component),
                          field("coordinate_frame", &Own::coordinate_frame));
    }
};

/// A command with up to seven numbers.
struct CommandLong {
    static constexpr std::uint32_t id = 76;
    static constexpr std::string_view name = "COMMAND_LONG";

    /// MAV_CMD_DO_SET_MODE: bits of the base mode, PX4's main mode, PX4's sub mode.
    static constexpr std::uint16_t do_set_mode = 176;
    /// MAV_CMD_DO_SET_ACTUATOR: six actuators of the payload, each from -1 to 1 or NaN, then which six.
    static constexpr std::uint16_t do_set_actuator = 187;

    float param1 = 0, param2 = 0, param3 = 0, param4 = 0, param5 = 0, param6 = 0, param7 = 0;
    std::uint16_t command = 0;  ///< MAV_CMD
    std::uint8_t target_system = 0, target_component = 0;
    std::uint8_t confirmation = 0;  ///< how often the command was sent before

    static constexpr auto fields() {
        return std::tuple(field("param1", &CommandLong::param1), field("param2", &CommandLong::param2),
                          field("param3", &CommandLong::param3), field("param4", &CommandLong::param4),
                          field("param5", &CommandLong::param5), field("param6", &CommandLong::param6),
                          field("param7", &CommandLong::param7), field("command", &CommandLong::command),
                          field("target_system", &CommandLong::target_system),
                          field("target_component", &CommandLong::target_component),
                          field("confirmation", &CommandLong::confirmation));
    }
};

/// The answer to a command.
struct CommandAck {
    static constexpr std::uint32_t id = 77;
    static constexpr std::string_view name = "COMMAND_ACK";

    /// MAV_RESULT.
    static constexpr std::uint8_t accepted = 0, temporarily_rejected = 1, denied = 2, unsupported = 3;

    std::uint16_t command = 0;
    std::uint8_t result = 0;
    std::uint8_t progress = 0;
    std::int32_t result_param2 = 0;
    std::uint8_t target_system = 0, target_component = 0;

    static constexpr auto fields() {
        return std::tuple(field("command", &CommandAck::command), field("result", &CommandAck::result),
                          extension("progress", &CommandAck::progress),
                          extension("result_param2", &CommandAck::result_param2),
                          extension("target_system", &CommandAck::target_system),
                          extension("target_component", &CommandAck::target_component));
    }
};

/// All messages that a reader knows.
using Messages = std::tuple<Heartbeat, Attitude, LocalPositionNed, SetPositionTargetLocalNed, CommandLong, CommandAck>;

// Values of Heartbeat.
inline constexpr std::uint8_t hexarotor_type = 13, onboard_controller_type = 18;                ///< MAV_TYPE
inline constexpr std::uint8_t no_autopilot = 8, px4_autopilot = 12;                             ///< MAV_AUTOPILOT
inline constexpr std::uint8_t custom_mode_enabled = 1, guided_enabled = 8, safety_armed = 128;  ///< MAV_MODE_FLAG
inline constexpr std::uint8_t active_state = 4, critical_state = 5, emergency_state = 6;        ///< MAV_STATE
inline constexpr std::uint8_t autopilot_component = 1, onboard_computer_component = 191;        ///< MAV_COMPONENT

/// PX4's custom_mode. @param main 4: automatic, 6: offboard   @param sub of automatic 3: hold ("loiter")
[[nodiscard]] constexpr std::uint32_t px4_mode(std::uint32_t main, std::uint32_t sub = 0) noexcept {
    constexpr unsigned main_bits = 16, sub_bits = 24;
    return main << main_bits | sub << sub_bits;
}
inline constexpr std::uint32_t px4_offboard_mode = px4_mode(6), px4_hold_mode = px4_mode(4, 3);

}  // namespace downwash::mavlink
