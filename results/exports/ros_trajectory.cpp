#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

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

Json header_json() {
    return {{"stamp", duration_json(0)}, {"frame_id", "world"}};
}

}  // namespace

std::string ros_trajectory(const RunRecord& run, const ExportSettings& settings) {
    const Vector3 none{0, 0, 0};
    Json vehicle = Json::array(), arm = Json::array();
    for (const Setpoint& point : setpoints_of(run, settings)) {
        const Json time = duration_json(point.t_s);
        vehicle.push_back(
            {{"transforms",
              {{{"translation", vector_json(point.position_m)}, {"rotation", rotation_json(point.yaw_rad)}}}},
             {"velocities", {{{"linear", vector_json(point.velocity_m_s)}, {"angular", vector_json(none)}}}},
             {"accelerations", {{{"linear", vector_json(point.acceleration_m_s2)}, {"angular", vector_json(none)}}}},
             {"time_from_start", time}});
        arm.push_back({{"positions", {point.arm_rad}},
                       {"velocities", {point.arm_rate_rad_s}},
                       {"accelerations", {point.arm_acceleration_rad_s2}},
                       {"effort", Json::array()},
                       {"time_from_start", time}});
    }
    const Json messages{
        {"multi_dof_joint_trajectory",
         {{"header", header_json()}, {"joint_names", {"base_link"}}, {"points", std::move(vehicle)}}},
        {"joint_trajectory", {{"header", header_json()}, {"joint_names", {"arm_joint"}}, {"points", std::move(arm)}}}};
    constexpr int indent = 1;
    return messages.dump(indent) + "\n";
}

}  // namespace downwash
