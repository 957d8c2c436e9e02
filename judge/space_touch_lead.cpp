#include "downwash/judge/space_touch_lead.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/judge/placement.hpp"

namespace downwash::judge {

using Eigen::Vector3d;

SpaceTouchLead::SpaceTouchLead(const TouchCourse& course, const SpaceTouch& touch, const SpaceRobot& robot,
                               const SpacePoint& from)
    : course_(course), touch_(touch), robot_(robot), from_(from), nominal_(vehicle_in(SpaceWorld{}, robot)) {}

Vector3d SpaceTouchLead::force_n() const {
    return nominal_.mass_kg() * answer_1_s2(touch_, robot_) * course_.pressed_m() * vector_of(touch_.normal);
}

std::optional<BodyPush> SpaceTouchLead::push() const {
    if (!is_told() || !(course_.pressed_m() > 0)) {
        return std::nullopt;
    }
    Vector3d lever_m = Vector3d::Zero();
    for (const SpaceTouchPoint& point : touch_.points) {
        lever_m += lever_of(nominal_, point) / static_cast<double>(touch_.points.size());
    }
    return BodyPush{static_cast<std::size_t>(touch_.points.front().link + 1), lever_m, force_n()};
}

SpacePoint SpaceTouchLead::reference() const {
    SpacePoint point = leant();
    const bool is_held = is_told() && course_.pressed_m() > 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double out = touch_.normal[static_cast<std::size_t>(axis)];
        point.position[axis] -= (is_held ? course_.beyond_m() - course_.pressed_m() : course_.beyond_m()) * out;
        point.velocity[axis] = is_held ? 0 : -course_.speed_m_s() * out;
    }
    return point;
}

SpacePoint SpaceTouchLead::leant() const {
    const int n = nominal_.joint_count();
    const Vector3d thrust = Vector3d(0, 0, nominal_.mass_kg() * standard_gravity_m_s2) - force_n();
    if (touch_.part == TouchingPart::frame || !(course_.pressed_m() > 0)) {
        return from_;
    }
    // The level hover, and the same with the thrust axis where it has to be and the first axis above its heading.
    SpaceCoordinates level;
    level.position_m = level.velocity_m_s = level.body_rate_rad_s = Vector3d::Zero();
    level.joints_rad = Eigen::Map<const Eigen::VectorXd>(from_.position + space::first_joint, n);
    level.joint_rates_rad_s = Eigen::VectorXd::Zero(n);
    const Eigen::Matrix3d heading = Eigen::AngleAxisd(from_.position[space::yaw], Vector3d::UnitZ()).toRotationMatrix();
    level.attitude = heading;
    SpaceCoordinates leant = level;
    Eigen::Matrix3d axes;
    axes.col(2) = thrust.normalized();
    axes.col(0) = heading.col(1).cross(axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    leant.attitude = axes;
    const Vector3d own_way = vector_of(robot_.tool_direction).normalized();
    const Vector3d wanted = bodies_at(nominal_, level).back().attitude * own_way;
    for (int step = 0; n > 0 && step < 8; ++step) {
        const BodyMotions bodies = bodies_at(nominal_, leant);
        const Vector3d way = bodies.back().attitude * own_way;
        Eigen::Matrix3Xd turns(3, n);
        for (int i = 0; i < n; ++i) {
            const auto joint = static_cast<std::size_t>(i);
            turns.col(i) = (bodies[joint].attitude * nominal_.joints[joint].axis).cross(way);
        }
        const Eigen::MatrixXd damped = turns.transpose() * turns + 0.01 * Eigen::MatrixXd::Identity(n, n);
        leant.joints_rad += damped.ldlt().solve(turns.transpose() * (wanted - way));
        for (int i = 0; i < n; ++i) {
            const SpaceLinkLimits& limits = robot_.links[static_cast<std::size_t>(i)];
            leant.joints_rad[i] = limits.is_limited
                                      ? std::clamp(leant.joints_rad[i], limits.lower_limit_rad, limits.upper_limit_rad)
                                      : leant.joints_rad[i];
        }
    }
    const auto tip_m = [&](const SpaceCoordinates& at) {
        const BodyMotion last = bodies_at(nominal_, at).back();
        return Vector3d(last.position_m + last.attitude * nominal_.end_effector_m);
    };
    const Vector3d moved_m = tip_m(level) - tip_m(leant);
    SpacePoint point = from_;
    for (int axis = 0; axis < 3; ++axis) {
        point.position[axis] += moved_m[axis];
    }
    std::copy_n(leant.joints_rad.data(), n, point.position + space::first_joint);
    return point;
}

}  // namespace downwash::judge
