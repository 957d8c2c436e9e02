#include "downwash/judge/space_attitude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace downwash::judge {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The wanted attitude: its third axis is the direction of the thrust, its first one in the vertical plane of the yaw.
Matrix3d wanted_attitude(const Vector3d& wanted, double yaw_rad) {
    Matrix3d axes;
    axes.col(2) = wanted;
    axes.col(0) = Vector3d(-std::sin(yaw_rad), std::cos(yaw_rad), 0).cross(wanted).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

}  // namespace

WantedDirection direction_of(const Vector3d& force, double max_tilt_rad, double least_vertical) {
    const double up = std::max(force.z(), least_vertical);
    const double sideways = std::hypot(force.x(), force.y());
    const double most = std::tan(max_tilt_rad) * up;
    const double share = sideways > most ? most / sideways : 1;
    return {Vector3d(share * force.x(), share * force.y(), up).normalized(),
            sideways > most || force.z() < least_vertical};
}

Vector3d shortest_turn(const Vector3d& from, const Vector3d& to, const Vector3d& if_opposite) {
    const Vector3d c = from.cross(to);
    const double sine = c.norm();
    if (sine > 1e-12) {
        // By the chords to the other end and to its opposite: exact near both.
        return 2 * std::atan2((to - from).norm(), (to + from).norm()) / sine * c;
    }
    return from.dot(to) < 0 ? Vector3d(std::numbers::pi * if_opposite) : Vector3d::Zero();
}

Matrix3d rotation_by(const Vector3d& turn_rad) {
    const double angle = turn_rad.norm();
    return angle > 0 ? Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix() : Matrix3d(Matrix3d::Identity());
}

YawLeft yaw_left(const Matrix3d& attitude, const Vector3d& axis, const Vector3d& wanted, double yaw_rad) {
    const Vector3d at = attitude * axis;
    const Matrix3d swung = rotation_by(shortest_turn(at, wanted, attitude.col(1))) * attitude;
    const Vector3d ahead = wanted_attitude(wanted, yaw_rad).transpose() * swung.col(0);
    return {-std::atan2(ahead.y(), ahead.x()), 0.5 * (1 + at.dot(wanted))};
}

double wanted_yaw_rate(const Vector3d& wanted, const Vector3d& direction_rate, double yaw_rad, double yaw_rate_rad_s) {
    // A difference of the wanted attitudes a moment later and earlier.
    constexpr double moment_s = 1e-4;
    const auto after = [&](double time_s) {
        return wanted_attitude(rotation_by(time_s * direction_rate) * wanted, yaw_rad + time_s * yaw_rate_rad_s);
    };
    const Matrix3d change = (after(moment_s) - after(-moment_s)) / (2 * moment_s);
    return change.col(0).dot(wanted_attitude(wanted, yaw_rad).col(1));
}

}  // namespace downwash::judge
