#include "px4.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <downwash/base/key_error.hpp>
#include <downwash/problems/space_problem_reader.hpp>

using namespace downwash;

namespace {

constexpr double max_acceleration_m_s2 = 3;  ///< MPC_ACC_HOR
constexpr double stop_delay_s = 0.6;         ///< until it brakes, as PX4 reckons

std::pair<double, double> range_rad(const SpaceLinkLimits& joint) {
    return joint.is_limited ? std::pair(joint.lower_limit_rad, joint.upper_limit_rad)
                            : std::pair(-std::numbers::pi, std::numbers::pi);
}

/// Position and velocity of PX4's outer loops after a while with a set-point that no longer changes, by Euler's method.
void hold_on(double& position, double& velocity, double position_p_1_s, double velocity_p_1_s, double acceleration,
             double tick_s) {
    const double last = position, feed_forward = velocity;
    for (double t_s = 0; t_s < loss_timeout_s; t_s += tick_s) {
        const double wanted = feed_forward + position_p_1_s * (last - position);
        velocity += tick_s * (acceleration + velocity_p_1_s * (wanted - velocity));
        position += tick_s * velocity;
    }
}

}  // namespace

SpaceProblem read_px4_problem(const std::string& file) {
    SpaceProblem problem = read_space_problem(file);
    if (!std::holds_alternative<Px4Cascade>(problem.robot.controller.law)) {
        throw_input_error("has another law: `downwash margins ROBOT --design --law px4-cascade` designs one",
                          "robot.controller.type");
    }
    return problem;
}

const Px4Cascade& px4_of(const SpaceRobot& robot) {
    return std::get<Px4Cascade>(robot.controller.law);
}

mavlink::SetPositionTargetLocalNed setpoint_of(const SpacePoint& reference, double time_s) {
    const auto axes = [](const double(&of)[space_axes<max_joints>], float& x, float& y, float& z) {
        const auto ned = turned_over(of[space::x], of[space::y], of[space::z]);
        x = static_cast<float>(ned[0]);
        y = static_cast<float>(ned[1]);
        z = static_cast<float>(ned[2]);
    };
    mavlink::SetPositionTargetLocalNed setpoint;
    setpoint.time_boot_ms = static_cast<std::uint32_t>(std::llround(1e3 * time_s));
    axes(reference.position, setpoint.x, setpoint.y, setpoint.z);
    axes(reference.velocity, setpoint.vx, setpoint.vy, setpoint.vz);
    axes(reference.acceleration, setpoint.afx, setpoint.afy, setpoint.afz);
    setpoint.yaw = static_cast<float>(std::remainder(-reference.position[space::yaw], 2 * std::numbers::pi));
    setpoint.yaw_rate = static_cast<float>(-reference.velocity[space::yaw]);
    setpoint.target_system = 1;
    setpoint.target_component = mavlink::autopilot_component;
    return setpoint;
}

SpacePoint reference_of(const mavlink::SetPositionTargetLocalNed& setpoint, const SpacePoint& before) {
    using Mask = mavlink::SetPositionTargetLocalNed;
    const unsigned ignored = setpoint.type_mask;
    SpacePoint reference = before;
    const auto put = [](const std::array<double, 3>& world, double(&axes)[space_axes<max_joints>], bool is_ignored) {
        for (std::size_t i = 0; i < world.size(); ++i) {
            axes[i] = is_ignored ? 0 : world[i];
        }
    };
    put(turned_over(setpoint.x, setpoint.y, setpoint.z), reference.position, false);
    put(turned_over(setpoint.vx, setpoint.vy, setpoint.vz), reference.velocity,
        (ignored & Mask::ignores_velocity) != 0);
    put(turned_over(setpoint.afx, setpoint.afy, setpoint.afz), reference.acceleration,
        (ignored & Mask::ignores_acceleration) != 0);
    const double yaw_before = before.position[space::yaw];
    if ((ignored & Mask::ignores_yaw) == 0) {
        reference.position[space::yaw] =
            yaw_before + std::remainder(-double{setpoint.yaw} - yaw_before, 2 * std::numbers::pi);
    }
    reference.velocity[space::yaw] = (ignored & Mask::ignores_yaw_rate) != 0 ? 0 : -double{setpoint.yaw_rate};
    return reference;
}

mavlink::CommandLong actuators_of(const SpacePoint& reference, const SpaceRobot& robot) {
    constexpr float unchanged = std::numeric_limits<float>::quiet_NaN();
    std::array<float, max_joints> values;
    values.fill(unchanged);
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const auto [low, high] = range_rad(robot.links[i]);
        values[i] = static_cast<float>(2 * (reference.position[space::first_joint + i] - low) / (high - low) - 1);
    }
    mavlink::CommandLong command{values[0], values[1], values[2], values[3], values[4], values[5]};
    command.command = mavlink::CommandLong::do_set_actuator;
    command.target_system = 1;
    command.target_component = mavlink::autopilot_component;
    return command;
}

double angle_at(double value, const SpaceLinkLimits& joint) {
    const auto [low, high] = range_rad(joint);
    return low + 0.5 * (std::clamp(value, -1., 1.) + 1) * (high - low);
}

SpacePlan stop_in_hold(const SpacePoint& from, int joints, double tick_s) {
    const double speed_m_s = std::hypot(from.velocity[space::x], from.velocity[space::y], from.velocity[space::z]);
    const double duration_s = speed_m_s / max_acceleration_m_s2 + 2 * stop_delay_s;  // to that place, evenly slower
    SpacePoint begin = rest_at(from), end = rest_at(from);
    for (const int axis : {space::x, space::y, space::z}) {
        begin.velocity[axis] = from.velocity[axis];
        end.position[axis] += 0.5 * duration_s * from.velocity[axis];
    }
    return {{{0, begin}, {std::llround(duration_s / tick_s), end}}, tick_s, joints};
}

SpacePlan flown_in_silence(const SpacePlan& plan, std::int64_t tick, const Px4Cascade& law) {
    const SpacePoint last = plan.at(tick);
    SpacePoint then = rest_at(last);
    for (const int axis : {space::x, space::y, space::z}) {
        const bool is_up = axis == space::z;
        then.velocity[axis] = last.velocity[axis];
        hold_on(then.position[axis], then.velocity[axis], is_up ? law.height_p_1_s : law.position_p_1_s,
                is_up ? law.vertical_velocity.kp_1_s : law.velocity.kp_1_s, last.acceleration[axis], plan.tick_s);
    }
    const SpacePlan waited{{{0, last}, {std::llround(loss_timeout_s / plan.tick_s), then}}, plan.tick_s, plan.joints};
    return waited.followed_by(stop_in_hold(then, plan.joints, plan.tick_s));
}
