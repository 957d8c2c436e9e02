#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
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

/// @param points whose joints move
Json joints_json(const RunInWorld& run, const std::vector<Setpoint>& points) {
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
    return {{"header", header_json()}, {"joint_names", std::move(names)}, {"points", std::move(list)}};
}

std::string text_of(const Json& messages) {
    constexpr int indent = 1;
    return messages.dump(indent) + "\n";
}

/// PX4's local frame: north, east, down. Its yaw counts clockwise from north, -pi to pi.
class LocalFrame {
 public:
    explicit LocalFrame(double bearing_deg)
        : bearing_rad_(bearing_deg / degrees_per_radian),
          sine_(std::sin(bearing_rad_)),
          cosine_(std::cos(bearing_rad_)) {}

    /// @param vector in the world
    [[nodiscard]] Vector3 of(const Vector3& vector) const {
        return {vector[0] * cosine_ + vector[1] * sine_, vector[0] * sine_ - vector[1] * cosine_, 0. - vector[2]};
    }
    [[nodiscard]] double yaw_rad(double world_yaw_rad) const {
        constexpr double whole_turn_rad = 6.283185307179586;
        return std::remainder(bearing_rad_ - world_yaw_rad, whole_turn_rad);
    }

 private:
    double bearing_rad_, sine_, cosine_;
};

}  // namespace

std::string ros_trajectory(const RunInWorld& run, const ExportSettings& settings) {
    const std::vector<Setpoint> points = setpoints_of(run, settings);
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
    return text_of({{"multi_dof_joint_trajectory",
                     {{"header", header_json()}, {"joint_names", {"base_link"}}, {"points", std::move(vehicle)}}},
                    {"joint_trajectory", joints_json(run, points)}});
}

std::string px4_setpoints(const RunInWorld& run, const ExportSettings& settings) {
    if (!(std::abs(settings.bearing_deg) <= max_bearing_deg)) {
        throw_input_error("the bearing is " + to_text(settings.bearing_deg) + " degrees: expected -360 to 360");
    }
    const LocalFrame frame(settings.bearing_deg);
    const std::vector<Setpoint> points = setpoints_of(run, settings);
    Json vehicle = Json::array();
    for (const Setpoint& point : points) {
        vehicle.push_back({{"timestamp", std::llround(point.t_s * 1e6)},
                           {"position", frame.of(point.position_m)},
                           {"velocity", frame.of(point.velocity_m_s)},
                           {"acceleration", frame.of(point.acceleration_m_s2)},
                           {"yaw", frame.yaw_rad(point.yaw_rad)},
                           {"yawspeed", 0. - point.yaw_rate_rad_s}});
    }
    return text_of({{"trajectory_setpoints", std::move(vehicle)}, {"joint_trajectory", joints_json(run, points)}});
}

}  // namespace downwash
