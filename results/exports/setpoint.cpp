#include "downwash/exports/setpoint.hpp"

namespace downwash {
namespace {

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
                      {},
                      {}};
    for (int joint = space::first_joint; joint < space::first_joint + joints; ++joint) {
        setpoint.joints.push_back({point.position[joint], point.velocity[joint], point.acceleration[joint]});
    }
    return setpoint;
}

}  // namespace downwash
