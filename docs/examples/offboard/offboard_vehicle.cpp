#include "offboard_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <downwash/base/infinity.hpp>
#include <downwash/simulation/execution.hpp>
#include <downwash/simulation/flight_rules.hpp>

#include "px4.hpp"

using namespace downwash;
using mavlink::CommandAck;
using mavlink::CommandLong;
using mavlink::SetPositionTargetLocalNed;

namespace {

std::unique_ptr<simulation::SpaceEffect> effect_of(const SpaceProblemModel& model) {
    const SpaceProblem& problem = model.problem();
    if (!problem.aero.enabled) {
        return std::make_unique<simulation::NoEffectInSpace>();
    }
    return std::make_unique<simulation::DirectSpaceEffect>(model.shared_scene(), problem.aero, problem.robot);
}

std::uint32_t milliseconds(double time_s) {
    return static_cast<std::uint32_t>(std::llround(1e3 * time_s));
}

mavlink::LocalPositionNed position_of(const SpaceMotion& motion, double time_s) {
    const auto& p = motion.position_m;
    const auto& v = motion.velocity_m_s;
    const auto at = turned_over(p[0], p[1], p[2]), moves = turned_over(v[0], v[1], v[2]);
    const auto number = [](double value) { return static_cast<float>(value); };
    return {milliseconds(time_s), number(at[0]),    number(at[1]),   number(at[2]),
            number(moves[0]),     number(moves[1]), number(moves[2])};
}

/// Roll, pitch and yaw of the axes forward, right, down, from north, east, down.
mavlink::Attitude attitude_of(const SpaceMotion& motion, double time_s) {
    const auto& q = motion.attitude;
    const auto& w = motion.body_rates_rad_s;
    const auto number = [](double value) { return static_cast<float>(value); };
    const double roll = std::atan2(2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
    const double pitch = -std::asin(std::clamp(2 * (q[0] * q[2] - q[3] * q[1]), -1., 1.));
    const double yaw = -std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    return {milliseconds(time_s), number(roll), number(pitch), number(yaw), number(w[0]), number(-w[1]), number(-w[2])};
}

bool is_finite(const SetPositionTargetLocalNed& setpoint) {
    bool all = true;
    const auto look = [&](const auto& field) {
        all = all && std::isfinite(static_cast<double>(setpoint.*field.member));
    };
    std::apply([&](const auto&... fields) { (look(fields), ...); }, SetPositionTargetLocalNed::fields());
    return all;
}

}  // namespace

OffboardVehicle::OffboardVehicle(const SpaceProblem& truth, const SpaceWorld& world)
    : model_(truth),
      world_(world),
      effect_(effect_of(model_)),
      loop_(simulation::make_space_loop(
          {truth.robot, world, *effect_, simulation::space_aero(truth.aero, truth.robot.rotor_radius_m)})),
      tick_s_(1 / truth.robot.controller.rate_hz),
      ticks_between_setpoints_(std::llround(setpoint_period_s / tick_s_)),
      reference_(rest_at(reference_at(truth.start))),
      stop_{{{0, reference_}}, tick_s_, truth.robot.joints()},
      min_clearance_m_(infinity) {
    for (std::size_t i = 0; i < truth.robot.links.size(); ++i) {
        servos_[i].angle_rad = reference_.position[space::first_joint + i];
    }
    loop_->start(start_motion(truth.start));
    SpaceFlightRow row;
    for (double t_s = 0; t_s < settling_before_start_s; t_s += tick_s_) {
        loop_->quiet_tick(reference_, row);
    }
    loop_->forget();
    judge();
}

void OffboardVehicle::take(std::string_view datagram) {
    for (const mavlink::Frame& frame : mavlink::FrameReader().take(datagram)) {
        if (const auto setpoint = mavlink::message_in<SetPositionTargetLocalNed>(frame)) {
            take(*setpoint);
        } else if (const auto command = mavlink::message_in<CommandLong>(frame)) {
            take(*command);
        }
    }
}

void OffboardVehicle::take(const SetPositionTargetLocalNed& setpoint) {
    constexpr std::uint8_t local_ned = 1;
    if ((setpoint.type_mask & (SetPositionTargetLocalNed::ignores_position | SetPositionTargetLocalNed::is_force)) !=
            0 ||
        setpoint.coordinate_frame != local_ned || !is_finite(setpoint)) {
        return;
    }
    if (time_s() - last_setpoint_s_ > loss_timeout_s || setpoints_ == 0) {
        first_setpoint_s_ = time_s();
    }
    last_setpoint_s_ = time_s();
    ++setpoints_;
    if (is_offboard()) {
        reference_ = reference_of(setpoint, reference_);
    }
}

void OffboardVehicle::take(const CommandLong& command) {
    CommandAck answer;
    answer.command = command.command;
    answer.result = CommandAck::accepted;
    if (command.command == CommandLong::do_set_mode) {
        answer.result = set_mode(command);
    } else if (command.command == CommandLong::do_set_actuator) {
        set_joints(command);
    } else {
        answer.result = CommandAck::unsupported;
    }
    answers_ += writer_.frame(answer);
}

std::uint8_t OffboardVehicle::set_mode(const CommandLong& command) {
    const auto number = [](float value) {
        return value >= 0 && value < 256 ? static_cast<std::uint32_t>(value) : 255U;
    };
    const std::uint32_t mode = mavlink::px4_mode(number(command.param2), number(command.param3));
    if (mode == mavlink::px4_hold_mode) {
        hold(false);
        return CommandAck::accepted;
    }
    if (mode != mavlink::px4_offboard_mode) {
        return CommandAck::unsupported;
    }
    if (setpoints_ == 0 || time_s() - last_setpoint_s_ > loss_timeout_s || time_s() - first_setpoint_s_ < warm_up_s) {
        return CommandAck::temporarily_rejected;
    }
    mode_ = mode;
    is_in_failsafe_ = false;
    next_heartbeat_s_ = time_s();
    return CommandAck::accepted;
}

void OffboardVehicle::set_joints(const CommandLong& command) {
    constexpr double max_gap_s = 0.1, smoothing = 0.5;
    const float values[max_joints] = {command.param1, command.param2, command.param3,
                                      command.param4, command.param5, command.param6};
    for (std::size_t i = 0; i < model_.problem().robot.links.size() && is_offboard(); ++i) {
        if (!std::isfinite(values[i])) {
            continue;
        }
        Servo& servo = servos_[i];
        const double angle_rad = angle_at(double{values[i]}, model_.problem().robot.links[i]);
        const double gap_s = time_s() - servo.commanded_s;
        if (gap_s > max_gap_s) {
            servo.rate_rad_s = 0;
        } else if (gap_s > 0) {
            servo.rate_rad_s += smoothing * ((angle_rad - servo.angle_rad) / gap_s - servo.rate_rad_s);
        }
        servo.angle_rad = angle_rad;
        servo.commanded_s = time_s();
    }
}

void OffboardVehicle::hold(bool is_failsafe) {
    if (!is_offboard()) {
        return;
    }
    const SpaceMotion now = loop_->motion();
    std::copy_n(now.position_m.begin(), 3, reference_.position);
    std::copy_n(now.velocity_m_s.begin(), 3, reference_.velocity);
    stop_ = stop_in_hold(reference_, model_.problem().robot.joints(), tick_s_);
    stopping_since_ = tick_;
    mode_ = mavlink::px4_hold_mode;
    is_in_failsafe_ = is_failsafe;
    next_heartbeat_s_ = time_s();
}

void OffboardVehicle::move_reference() {
    constexpr double max_lead_s = 2 * setpoint_period_s;
    if (is_offboard() && time_s() - last_setpoint_s_ > loss_timeout_s) {
        hold(true);
    }
    if (!is_offboard()) {
        reference_ = stop_.at(tick_ - stopping_since_);
        return;
    }
    for (std::size_t i = 0; i < model_.problem().robot.links.size(); ++i) {
        const Servo& servo = servos_[i];
        const double since_s = time_s() - servo.commanded_s;
        const bool moves = since_s < max_lead_s;
        const std::size_t axis = space::first_joint + i;
        reference_.position[axis] = servo.angle_rad + std::min(since_s, setpoint_period_s) * servo.rate_rad_s;
        reference_.velocity[axis] = moves ? servo.rate_rad_s : 0;
    }
}

void OffboardVehicle::tick() {
    if (outcome_ != Outcome::ok) {
        return;
    }
    move_reference();
    SpaceFlightRow row;
    loop_->tick(tick_++, reference_, row);
    judge();
}

void OffboardVehicle::judge() {
    const SpaceMotion motion = loop_->motion();
    const auto& p = motion.position_m;
    const double error_m = std::hypot(p[0] - reference_.position[space::x], p[1] - reference_.position[space::y],
                                      p[2] - reference_.position[space::z]);
    if (!(error_m <= unstable_error_m)) {
        outcome_ = Outcome::unstable;
        return;
    }
    min_clearance_m_ = std::min(min_clearance_m_, model_.collisions().clearance_m(among_obstacles(motion, world_)));
    if (min_clearance_m_ <= 0) {
        outcome_ = Outcome::collision;
    } else if (!loop_->is_flyable()) {
        outcome_ = Outcome::left_flyable_area;
    }
}

std::string OffboardVehicle::heartbeat() {
    mavlink::Heartbeat heartbeat;
    heartbeat.custom_mode = mode_;
    heartbeat.type = mavlink::hexarotor_type;
    heartbeat.autopilot = mavlink::px4_autopilot;
    heartbeat.base_mode = mavlink::custom_mode_enabled | mavlink::guided_enabled | mavlink::safety_armed;
    heartbeat.system_status = outcome_ != Outcome::ok ? mavlink::emergency_state
                              : is_in_failsafe_       ? mavlink::critical_state
                                                      : mavlink::active_state;
    return writer_.frame(heartbeat);
}

std::string OffboardVehicle::sent() {
    std::string datagram = std::exchange(answers_, {});
    if (time_s() >= next_heartbeat_s_) {
        next_heartbeat_s_ = time_s() + 1;
        datagram += heartbeat();
    }
    if (is_telemetry_due()) {
        const SpaceMotion now = loop_->motion();
        datagram += writer_.frame(attitude_of(now, time_s())) + writer_.frame(position_of(now, time_s()));
    }
    return datagram;
}
