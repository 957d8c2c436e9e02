#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/exports/setpoint_file.hpp"
#include "downwash/mavlink/frame.hpp"
#include "downwash/mavlink/messages.hpp"

// Logs of MAVLink as QGroundControl and pymavlink write them (.tlog): before each frame a time in microseconds, in
// eight bytes, the highest first.

namespace downwash {
namespace {

using mavlink::SetPositionTargetLocalNed;

constexpr std::size_t stamp_bytes = 8;
constexpr double second_ms = 1000;
constexpr std::uint8_t local_ned_frame = 1;  // MAV_FRAME_LOCAL_NED
constexpr char mavlink_1 = '\xfe', mavlink_2 = '\xfd';

SetPositionTargetLocalNed message_of(const Setpoint& point) {
    const auto single = [](double number) { return static_cast<float>(number); };
    SetPositionTargetLocalNed message;
    message.time_boot_ms = static_cast<std::uint32_t>(std::llround(point.t_s * second_ms));
    const auto& [x, y, z] = point.position_m;
    const auto& [vx, vy, vz] = point.velocity_m_s;
    const auto& [ax, ay, az] = point.acceleration_m_s2;
    message.x = single(x), message.y = single(y), message.z = single(z);
    message.vx = single(vx), message.vy = single(vy), message.vz = single(vz);
    message.afx = single(ax), message.afy = single(ay), message.afz = single(az);
    message.yaw = single(point.yaw_rad);
    message.yaw_rate = single(point.yaw_rate_rad_s);
    message.type_mask = 0;  // everything is given, and nothing ignored
    message.target_system = 1;
    message.target_component = mavlink::autopilot_component;
    message.coordinate_frame = local_ned_frame;
    return message;
}

Setpoint setpoint_of(const SetPositionTargetLocalNed& message) {
    Setpoint point;
    point.t_s = message.time_boot_ms / second_ms;
    point.position_m = {message.x, message.y, message.z};
    point.velocity_m_s = {message.vx, message.vy, message.vz};
    point.acceleration_m_s2 = {message.afx, message.afy, message.afz};
    point.yaw_rad = message.yaw;
    point.yaw_rate_rad_s = message.yaw_rate;
    return point;
}

std::string stamp(std::uint32_t time_ms) {
    constexpr std::uint64_t millisecond_us = 1000;
    std::string bytes;
    append_little_endian(bytes, time_ms * millisecond_us);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// The length of the frame that begins at a byte; nothing if none does. @param bytes from there on
std::optional<std::size_t> frame_length(std::string_view bytes) {
    constexpr std::size_t around_1 = 8, around_2 = 12, signature = 13;
    if (bytes.size() < around_1 || (bytes[0] != mavlink_1 && bytes[0] != mavlink_2)) {
        return std::nullopt;
    }
    const auto payload = static_cast<std::size_t>(static_cast<unsigned char>(bytes[1]));
    if (bytes[0] == mavlink_1) {
        return around_1 + payload;
    }
    const bool is_signed = (static_cast<unsigned char>(bytes[2]) & 1U) != 0;
    return around_2 + payload + (is_signed ? signature : 0);
}

std::uint32_t message_id(std::string_view frame) {
    const auto byte = [&](std::size_t place) { return std::uint32_t{static_cast<unsigned char>(frame[place])}; };
    return frame[0] == mavlink_1 ? byte(5) : byte(7) | byte(8) << 8U | byte(9) << 16U;
}

/// What keeps a message from being a whole set-point; empty if nothing does.
std::string error_of(const SetPositionTargetLocalNed& message) {
    const Setpoint point = setpoint_of(message);
    if (message.coordinate_frame != local_ned_frame) {
        return "coordinate_frame is " + std::to_string(message.coordinate_frame) + ": expected 1, MAV_FRAME_LOCAL_NED";
    }
    if (message.type_mask != 0) {
        return "type_mask is " + std::to_string(message.type_mask) + ": expected 0, which ignores nothing";
    }
    if (!is_finite(point.position_m) || !is_finite(point.velocity_m_s) || !is_finite(point.acceleration_m_s2) ||
        !std::isfinite(message.yaw) || !std::isfinite(message.yaw_rate)) {
        return "holds what is no finite number";
    }
    return "";
}

}  // namespace

std::string mavlink_log(const RunInWorld& run, const ExportSettings& settings) {
    if (settings.rate_hz.value_or(run.rate_hz) > second_ms) {
        throw_input_error("messages of MAVLink have whole milliseconds: expected a rate of at most 1000 Hz");
    }
    const WayInWorld& plan = plan_to_be_flown(run);
    const SetpointAxes axes(SetpointFrame::north_east_down, settings.bearing_deg);
    // Where the plan is at the time that the message has.
    const auto at = [&](double t_s) { return axes.of(plan.at(std::round(t_s * second_ms) / second_ms)); };
    mavlink::FrameWriter writer(1, mavlink::onboard_computer_component);
    std::string bytes;
    std::optional<std::uint32_t> before_ms;
    for (const Setpoint& point :
         setpoints(at, std::max(plan.end_s, plan.duration_s()), settings.rate_hz.value_or(run.rate_hz))) {
        const SetPositionTargetLocalNed message = message_of(point);
        if (message.time_boot_ms != before_ms) {  // the end may follow at once
            bytes += stamp(message.time_boot_ms) + writer.frame(message);
        }
        before_ms = message.time_boot_ms;
    }
    return bytes;
}

bool is_mavlink_log(std::string_view bytes) {
    return bytes.size() > stamp_bytes && bytes[0] == 0 &&
           (bytes[stamp_bytes] == mavlink_1 || bytes[stamp_bytes] == mavlink_2);
}

SetpointFile read_mavlink_log(std::string_view bytes, const std::string& file) {
    SetpointFile read{.format = "mavlink", .frame = SetpointFrame::north_east_down};
    LineErrors errors(file);
    const auto add_at = [](LineErrors& to, std::size_t byte, const std::string& message) {
        to.add(0, "byte " + std::to_string(byte) + ": " + message);
    };
    std::vector<std::size_t> places;
    for (std::size_t at = stamp_bytes; at < bytes.size();) {
        const std::string_view rest = bytes.substr(at);
        const std::optional<std::size_t> length = frame_length(rest);
        if (!length || *length > rest.size()) {
            add_at(
                errors, at,
                length || rest.size() < stamp_bytes ? "the file ends within a frame" : "expected a frame of MAVLink");
            break;
        }
        const std::string_view frame = rest.substr(0, *length);
        if (message_id(frame) == SetPositionTargetLocalNed::id) {
            const std::vector<mavlink::Frame> found = mavlink::FrameReader().take(frame);
            const auto message =
                found.size() == 1 ? mavlink::message_in<SetPositionTargetLocalNed>(found.front()) : std::nullopt;
            const std::string error = message ? error_of(*message) : "the frame is damaged, or of MAVLink 1";
            if (!error.empty()) {
                add_at(errors, at, error);
            } else {
                read.points.push_back(setpoint_of(*message));
                places.push_back(at);
            }
        }
        at += *length + stamp_bytes;
    }
    errors.throw_any();
    read.add = [places = std::move(places), add_at](LineErrors& to, std::size_t point, const std::string& message) {
        add_at(to, places[point], message);
    };
    require_rising_times(read, file);
    return read;
}

}  // namespace downwash
