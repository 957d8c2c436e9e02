#include "downwash/exports/setpoint_axes.hpp"

#include <cmath>
#include <numbers>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

Matrix3 axes_of(SetpointFrame frame, double bearing_rad) {
    const double sine = std::sin(bearing_rad), cosine = std::cos(bearing_rad);
    const Vector3 north{cosine, sine, 0}, east{sine, -cosine, 0};
    return frame == SetpointFrame::north_east_down ? Matrix3{north, east, {0, 0, -1}} : Matrix3{east, north, {0, 0, 1}};
}

}  // namespace

SetpointAxes::SetpointAxes(SetpointFrame frame, double bearing_deg)
    : frame_(frame), axes_(), bearing_rad_(bearing_deg / degrees_per_radian) {
    if (!(std::abs(bearing_deg) <= max_bearing_deg)) {
        throw_input_error("the bearing is " + to_text(bearing_deg) + " degrees: expected -360 to 360");
    }
    axes_ = axes_of(frame, bearing_rad_);
}

Vector3 SetpointAxes::of(const Vector3& in_world) const {
    return frame_ == SetpointFrame::world ? in_world : axes_ * in_world;
}

Setpoint SetpointAxes::of(const Setpoint& in_world) const {
    Setpoint point = in_world;
    point.position_m = of(in_world.position_m);
    point.velocity_m_s = of(in_world.velocity_m_s);
    point.acceleration_m_s2 = of(in_world.acceleration_m_s2);
    point.jerk_m_s3 = of(in_world.jerk_m_s3);
    point.yaw_rad = yaw_rad(in_world.yaw_rad);
    if (frame_ == SetpointFrame::north_east_down) {
        point.yaw_rate_rad_s = 0. - in_world.yaw_rate_rad_s;
        point.yaw_acceleration_rad_s2 = 0. - in_world.yaw_acceleration_rad_s2;
    }
    return point;
}

double SetpointAxes::yaw_rad(double in_world_rad) const {
    constexpr double whole_turn_rad = 2 * std::numbers::pi;
    switch (frame_) {
        case SetpointFrame::north_east_down:
            return std::remainder(bearing_rad_ - in_world_rad, whole_turn_rad);
        case SetpointFrame::east_north_up:
            return in_world_rad + whole_turn_rad / 4 - bearing_rad_;
        case SetpointFrame::world:
            break;
    }
    return in_world_rad;
}

}  // namespace downwash
