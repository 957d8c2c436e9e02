#include "downwash/exports/setpoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr double max_setpoints = 1e6;
constexpr double max_rate_hz = 10000;

Vector3 in_world(const PlaneOfMotion& plane, const double vector[3]) {
    return {vector[plane::x] * plane.cos_heading(), vector[plane::x] * plane.sin_heading(), vector[plane::z]};
}

Vector3 place_of(const double numbers[]) {
    return {numbers[space::x], numbers[space::y], numbers[space::z]};
}

}  // namespace

Setpoint setpoint_of(double t_s, const ReferencePoint& point, const PlaneOfMotion& plane) {
    Setpoint setpoint;
    setpoint.t_s = t_s;
    setpoint.position_m = plane.to_world(point.position[plane::x], 0, point.position[plane::z]);
    setpoint.velocity_m_s = in_world(plane, point.velocity);
    setpoint.acceleration_m_s2 = in_world(plane, point.acceleration);
    setpoint.yaw_rad = plane.heading_rad();
    setpoint.joints = {{point.position[plane::arm], point.velocity[plane::arm], point.acceleration[plane::arm]}};
    return setpoint;
}

Setpoint setpoint_of(double t_s, const SpacePoint& point, int joints) {
    Setpoint setpoint{t_s,
                      place_of(point.position),
                      place_of(point.velocity),
                      place_of(point.acceleration),
                      point.position[space::yaw],
                      point.velocity[space::yaw],
                      point.acceleration[space::yaw],
                      {}};
    for (int joint = space::first_joint; joint < space::first_joint + joints; ++joint) {
        setpoint.joints.push_back({point.position[joint], point.velocity[joint], point.acceleration[joint]});
    }
    return setpoint;
}

std::vector<Setpoint> setpoints(const std::function<Setpoint(double t_s)>& at, double end_s, double rate_hz) {
    if (!(rate_hz > 0 && rate_hz <= max_rate_hz)) {
        throw_input_error("the rate is " + to_text(rate_hz) + " Hz: expected above 0 and at most 10000 Hz");
    }
    if (end_s * rate_hz > max_setpoints) {
        throw_input_error(to_text(end_s, 6) + " s at " + to_text(rate_hz) +
                          " Hz are more than a million set-points: lower the rate");
    }
    std::vector<Setpoint> points;
    constexpr double nearly = 1e-9;  // of a period: the end counts once
    for (std::int64_t i = 0; static_cast<double>(i) < end_s * rate_hz - nearly; ++i) {
        points.push_back(at(static_cast<double>(i) / rate_hz));
    }
    points.push_back(at(end_s));
    return points;
}

std::vector<Setpoint> setpoints(const Plan& plan, const PlaneOfMotion& plane, double end_s, double rate_hz) {
    return setpoints([&](double t_s) { return setpoint_of(t_s, plan.at_time(t_s), plane); },
                     std::max(end_s, plan.duration_s()), rate_hz);
}

std::vector<Setpoint> setpoints(const SpacePlan& plan, double end_s, double rate_hz) {
    return setpoints([&](double t_s) { return setpoint_of(t_s, plan.at_time(t_s), plan.joints); },
                     std::max(end_s, plan.duration_s()), rate_hz);
}

}  // namespace downwash
