#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vector3& vector) {
    return {{"x", vector[0]}, {"y", vector[1]}, {"z", vector[2]}};
}

/// About z.
Json rotation_json(double yaw_rad) {
    return {{"x", 0.}, {"y", 0.}, {"z", std::sin(yaw_rad / 2)}, {"w", std::cos(yaw_rad / 2)}};
}

Json duration_json(double t_s) {
    constexpr std::int64_t second_ns = 1'000'000'000;
    const auto t_ns = static_cast<std::int64_t>(std::llround(t_s * 1e9));
    return {{"sec", t_ns / second_ns}, {"nanosec", t_ns % second_ns}};
}

Json header_json(std::string_view frame_id) {
    return {{"stamp", duration_json(0)}, {"frame_id", frame_id}};
}

/// @param points whose joints move
Json joints_json(const RunInWorld& run, const std::vector<Setpoint>& points, std::string_view frame_id = "world") {
    Json names = Json::array(), list = Json::array();
    for (const JointInWorld& joint : run.joints) {
        names.push_back(joint.name);
    }
    for (const Setpoint& point : points) {
        Json angles = Json::array(), rates = Json::array(), accelerations = Json::array();
        for (const JointSetpoint& joint : point.joints) {
            angles.push_back(joint.angle_rad);
            rates.push_back(joint.rate_rad_s);
            accelerations.push_back(joint.acceleration_rad_s2);
        }
        list.push_back({{"positions", std::move(angles)},
                        {"velocities", std::move(rates)},
                        {"accelerations", std::move(accelerations)},
                        {"effort", Json::array()},
                        {"time_from_start", duration_json(point.t_s)}});
    }
    return {{"header", header_json(frame_id)}, {"joint_names", std::move(names)}, {"points", std::move(list)}};
}

std::string text_of(const Json& messages) {
    constexpr int indent = 1;
    return messages.dump(indent) + "\n";
}

}  // namespace

std::string ros_trajectory(const RunInWorld& run, const ExportSettings& settings) {
    const bool is_map = settings.is_east_north_up;
    const std::string_view frame_id = is_map ? map_frame_id : "world";
    const std::vector<Setpoint> points =
        setpoints_of(run, settings, is_map ? SetpointFrame::east_north_up : SetpointFrame::world);
    Json vehicle = Json::array();
    for (const Setpoint& point : points) {
        vehicle.push_back(
            {{"transforms",
              {{{"translation", vector_json(point.position_m)}, {"rotation", rotation_json(point.yaw_rad)}}}},
             {"velocities",
              {{{"linear", vector_json(point.velocity_m_s)}, {"angular", vector_json({0, 0, point.yaw_rate_rad_s})}}}},
             {"accelerations",
              {{{"linear", vector_json(point.acceleration_m_s2)},
                {"angular", vector_json({0, 0, point.yaw_acceleration_rad_s2})}}}},
             {"time_from_start", duration_json(point.t_s)}});
    }
    return text_of(
        {{"multi_dof_joint_trajectory",
          {{"header", header_json(frame_id)}, {"joint_names", {"base_link"}}, {"points", std::move(vehicle)}}},
         {"joint_trajectory", joints_json(run, points, frame_id)}});
}

std::string px4_setpoints(const RunInWorld& run, const ExportSettings& settings) {
    const std::vector<Setpoint> points = setpoints_of(run, settings, SetpointFrame::north_east_down);
    Json vehicle = Json::array();
    for (const Setpoint& point : points) {
        vehicle.push_back({{"timestamp", whole_us(point.t_s)},
                           {"position", point.position_m},
                           {"velocity", point.velocity_m_s},
                           {"acceleration", point.acceleration_m_s2},
                           {"jerk", point.jerk_m_s3},
                           {"yaw", point.yaw_rad},
                           {"yawspeed", point.yaw_rate_rad_s}});
    }
    return text_of({{"trajectory_setpoints", std::move(vehicle)}, {"joint_trajectory", joints_json(run, points)}});
}

}  // namespace downwash
