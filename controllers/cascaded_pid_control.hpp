#pragma once

#include <cmath>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/actuate.hpp"
#include "downwash/controllers/cascaded_pid.hpp"
#include "downwash/controllers/pid.hpp"

// The law of CascadedPid.

namespace downwash {

template <class T>
CascadedPid::Memory<T> CascadedPid::rested(const PlantModel& nominal, const dynamics::PlantState<T>& state) const {
    const T still[4] = {T(0), T(0), T(0), T(0)};
    const dynamics::EquationsOfMotion<T> e = dynamics::motion_at(nominal, state.q, still).equations;
    const auto carries = [](double ki, double limit, T action) {
        return ki > 0 ? lane::clamp(action, T(-limit), T(limit)) / T(ki) : T(0);
    };
    return {{T(0), T(0)},
            carries(pitch_rate_ki, pitch_integral_limit_nm, e.bias[2]),
            carries(joint_ki, joint_integral_limit_nm, e.bias[3]),
            {state.u[0], state.u[1]},
            state.u[2]};
}

template <class T, class Aid>
CascadedPid::Memory<T> CascadedPid::control(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                            const dynamics::Motion<T>& motion, const Memory<T>& memory,
                                            const BasicReferencePoint<T>& reference, double tick_s,
                                            controllers::Actuation<T>& given, Aid&& aid) const {
    const T* q = seen.q;
    const T* u = seen.u;
    const dynamics::Attitude<T>& a = motion.attitude;
    const T dt_s(tick_s);

    // Position to velocity to acceleration: the force of a point of the whole mass.
    T force[2];
    T velocity_error[2];
    for (int i = 0; i < 2; ++i) {
        const AxisGains gains = axis_gains(i);
        velocity_error[i] = reference.velocity[i] + T(gains.position_kp) * (reference.position[i] - q[i]) - u[i];
        T acceleration =
            reference.acceleration[i] + T(gains.velocity_kp) * velocity_error[i] +
            controllers::integral_action(gains.velocity_ki, gains.integral_limit_m_s2, memory.velocity_integral[i]);
        if (gains.velocity_kd > 0) {
            acceleration = acceleration - T(gains.velocity_kd / tick_s) * (u[i] - memory.previous_velocity[i]);
        }
        force[i] = T(nominal.total_mass_kg) * acceleration - aid.template force<T>(i);
    }
    force[1] = force[1] + T(nominal.weight_n);

    // Its direction is the tilt; along b3 it is the thrust.
    const T least_force_z(min_vertical_force_ratio * nominal.weight_n);
    const T wanted_pitch = lane::atan2(force[0], lane::max(force[1], least_force_z));
    const T pitch_reference = lane::clamp(wanted_pitch, T(-max_tilt_rad), T(max_tilt_rad));
    const auto is_force_clipped = lane::max(lane::abs(wanted_pitch - pitch_reference), least_force_z - force[1]) > T(0);
    const T thrust_n = force[0] * a.sin_pitch + force[1] * a.cos_pitch;

    // Pitch to pitch rate to torque.
    const T rate_error = T(pitch_angle_kp) * (pitch_reference - q[2]) - u[2];
    T pitch_torque_nm = T(pitch_rate_kp) * rate_error +
                        controllers::integral_action(pitch_rate_ki, pitch_integral_limit_nm, memory.rate_integral);
    if (pitch_rate_kd > 0) {
        pitch_torque_nm = pitch_torque_nm - T(pitch_rate_kd / tick_s) * (u[2] - memory.previous_pitch_rate);
    }
    const T arm_error = reference.position[2] - q[3];
    const T joint_torque_nm = T(joint_kp) * arm_error + T(joint_kd) * (reference.velocity[2] - u[3]) +
                              controllers::integral_action(joint_ki, joint_integral_limit_nm, memory.joint_integral);

    aid.command_rotors(nominal, seen, thrust_n, pitch_torque_nm - aid.template force<T>(2), tick_s, rotor_lead, given);
    controllers::command_joint(nominal, joint_torque_nm - aid.template force<T>(3), given);

    // Integrators stand still where something was clipped (anti-windup).
    const auto is_clipped = given.saturation > T(1);
    Memory<T> next;
    for (int i = 0; i < 2; ++i) {
        const AxisGains gains = axis_gains(i);
        const T integral = controllers::integrate(gains.velocity_ki, gains.integral_limit_m_s2,
                                                  memory.velocity_integral[i], velocity_error[i], dt_s);
        next.velocity_integral[i] = lane::select(is_clipped, memory.velocity_integral[i],
                                                 lane::select(is_force_clipped, memory.velocity_integral[i], integral));
        next.previous_velocity[i] = u[i];
    }
    next.rate_integral = lane::select(
        is_clipped, memory.rate_integral,
        controllers::integrate(pitch_rate_ki, pitch_integral_limit_nm, memory.rate_integral, rate_error, dt_s));
    next.joint_integral =
        lane::select(is_clipped, memory.joint_integral,
                     controllers::integrate(joint_ki, joint_integral_limit_nm, memory.joint_integral, arm_error, dt_s));
    next.previous_pitch_rate = u[2];
    return next;
}

inline controllers::Rest<CascadedPid::Memory> CascadedPid::rest(const PlantModel& nominal,
                                                                const dynamics::EquationsOfMotion<double>& equations,
                                                                const controllers::RestingCommand& command) const {
    const double thrust_n = command.wrench.thrust_n;
    const double* known = command.known_force;
    const auto rate = controllers::settled_pid(command.wrench.pitch_torque_nm + known[2], pitch_rate_kp, pitch_rate_ki,
                                               pitch_integral_limit_nm);
    const auto joint =
        controllers::settled_pid(command.joint_torque_nm + known[3], joint_kp, joint_ki, joint_integral_limit_nm);
    controllers::Rest<Memory> rest;
    rest.pitch_reference_rad = controllers::error_for(rate.error, pitch_angle_kp);
    double sine = 0;
    double cosine = 1;
    lane::sin_cos(rest.pitch_reference_rad, sine, cosine);
    const double acceleration[2] = {(sine / cosine * thrust_n + known[0]) / nominal.total_mass_kg,
                                    (thrust_n + known[1] - nominal.weight_n) / nominal.total_mass_kg};
    for (int i = 0; i < 2; ++i) {
        const AxisGains gains = axis_gains(i);
        const auto velocity =
            controllers::settled_pid(acceleration[i], gains.velocity_kp, gains.velocity_ki, gains.integral_limit_m_s2);
        rest.error[i] = controllers::error_for(velocity.error, gains.position_kp);
        rest.memory.velocity_integral[i] = velocity.integral;
        rest.feeds_back.velocity_integral[i] = velocity.feeds_back;
        rest.feeds_back.previous_velocity[i] = gains.velocity_kd > 0;
    }
    rest.error[2] = joint.error;
    rest.memory.rate_integral = rate.integral;
    rest.memory.joint_integral = joint.integral;
    rest.feeds_back.rate_integral = rate.feeds_back;
    rest.feeds_back.joint_integral = joint.feeds_back;
    rest.feeds_back.previous_pitch_rate = pitch_rate_kd > 0;
    const double nothing[3] = {};
    rest.height_gain_1_s2 = vertical_position_kp * vertical_velocity_kp;
    rest.pitch_gain_1_s2 =
        pitch_angle_kp * pitch_rate_kp / dynamics::rotational_system(nominal, equations, nothing).s55;
    if (!(std::abs(rest.pitch_reference_rad) < max_tilt_rad)) {
        rest.limit = HoldLimit::tilt;
    } else if (!(thrust_n > min_vertical_force_ratio * nominal.weight_n)) {
        rest.limit = HoldLimit::vertical;
    } else if (!std::isfinite(rest.error[0] + rest.error[1] + rest.error[2])) {
        rest.limit = HoldLimit::gain;
    }
    return rest;
}

}  // namespace downwash
