#pragma once

#include <cmath>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/actuate.hpp"
#include "downwash/controllers/model_inversion.hpp"
#include "downwash/controllers/pid.hpp"

// The law of ModelInversion.

namespace downwash {

template <class T, class Aid>
ModelInversion::Memory<T> ModelInversion::control(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                                  const dynamics::Motion<T>& motion, const Memory<T>& memory,
                                                  const BasicReferencePoint<T>& reference, double tick_s,
                                                  controllers::Actuation<T>& given, Aid&& aid) const {
    const dynamics::Motion<T>& explained = aid.explained(motion);
    const Step<T> step = demanded(nominal, seen, explained, memory, reference, T(tick_s));
    controllers::actuate(nominal, seen, explained, step.demand, tick_s, given, rotor_lead, aid);
    return select_each(given.saturation > T(1), step.frozen, step.integrated);
}

template <class T>
ModelInversion::Step<T> ModelInversion::demanded(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                                 const dynamics::Motion<T>& motion, const Memory<T>& memory,
                                                 const BasicReferencePoint<T>& reference, T dt_s) const {
    const T* q = seen.q;
    const T* u = seen.u;
    const dynamics::Attitude<T>& a = motion.attitude;
    const dynamics::EquationsOfMotion<T>& e = motion.equations;
    Step<T> step;
    step.frozen = memory;

    // Position and arm PID: the accelerations to impose.
    T v[2];
    T error[2];
    for (int i = 0; i < 2; ++i) {
        error[i] = reference.position[i] - q[i];
        const AxisGains gains = axis_gains(i);
        v[i] = reference.acceleration[i] + T(gains.kd) * (reference.velocity[i] - u[i]) + T(gains.kp) * error[i] +
               controllers::integral_action(gains.ki, position_integral_limit_m_s2, memory.position_integral[i]);
    }
    const T arm_error = reference.position[2] - q[3];
    const T v7 = reference.acceleration[2] + T(arm_kd) * (reference.velocity[2] - u[3]) + T(arm_kp) * arm_error +
                 controllers::integral_action(arm_ki, arm_integral_limit_rad_s2, memory.arm_integral);

    // D13^-1: the force that gives these accelerations, its direction as pitch reference.
    const T mass(nominal.total_mass_kg);
    const T arm_mass(nominal.arm_mass_kg);
    const T force_x = mass * v[0] + arm_mass * e.arm_x * v7 + e.bias[0];
    const T force_z = mass * v[1] + arm_mass * e.arm_z * v7 + e.bias[1];
    const T least_force_z(min_vertical_force_ratio * nominal.total_mass_kg * standard_gravity_m_s2);
    const T wanted_pitch = lane::atan2(force_x, lane::max(force_z, least_force_z));
    const T pitch_reference = lane::clamp(wanted_pitch, T(-max_tilt_rad), T(max_tilt_rad));
    const auto is_force_clipped = lane::max(lane::abs(wanted_pitch - pitch_reference), least_force_z - force_z) > T(0);
    step.demand.thrust_n = force_x * a.sin_pitch + force_z * a.cos_pitch;

    // K5^-1: pitch rate reference, from a filtered backward difference of the pitch reference.
    const T raw_rate = (pitch_reference - memory.pitch_reference_rad) / dt_s;
    const T blend = dt_s / (T(pitch_rate_filter_s) + dt_s);
    step.frozen.pitch_reference_rad = pitch_reference;
    step.frozen.pitch_reference_rate = memory.pitch_reference_rate + blend * (raw_rate - memory.pitch_reference_rate);
    const T rate_reference = step.frozen.pitch_reference_rate + T(attitude_kp) * (pitch_reference - q[2]);
    step.frozen.rate_reference = rate_reference;

    // D5^-1: the pitch torque for the pitch acceleration, with the accelerations that this thrust will really give.
    const T rate_error = rate_reference - u[2];
    T v5 = T(attitude_rate_kp) * rate_error +
           controllers::integral_action(attitude_rate_ki, attitude_integral_limit_rad_s2, memory.pitch_rate_integral);
    if (rate_feed_forward) {
        v5 = v5 + (rate_reference - memory.rate_reference) / dt_s;
    }
    const T thrust = step.demand.thrust_n;
    const T inverse_mass(nominal.inverse_mass_1_kg);
    const T acceleration[4] = {
        (thrust * a.sin_pitch - e.bias[0] - arm_mass * (e.pitch_x * v5 + e.arm_x * v7)) * inverse_mass,
        (thrust * a.cos_pitch - e.bias[1] - arm_mass * (e.pitch_z * v5 + e.arm_z * v7)) * inverse_mass, v5, v7};
    T force[4];
    dynamics::inverse_dynamics(nominal, e, acceleration, force);
    step.demand.pitch_torque_nm = force[2];
    step.demand.arm_acceleration = v7;

    step.integrated = step.frozen;
    for (int i = 0; i < 2; ++i) {
        const T integral = controllers::integrate(axis_gains(i).ki, position_integral_limit_m_s2,
                                                  memory.position_integral[i], error[i], dt_s);
        step.integrated.position_integral[i] = lane::select(is_force_clipped, memory.position_integral[i], integral);
    }
    step.integrated.pitch_rate_integral = controllers::integrate(attitude_rate_ki, attitude_integral_limit_rad_s2,
                                                                 memory.pitch_rate_integral, rate_error, dt_s);
    step.integrated.arm_integral =
        controllers::integrate(arm_ki, arm_integral_limit_rad_s2, memory.arm_integral, arm_error, dt_s);
    return step;
}

inline controllers::Rest<ModelInversion::Memory> ModelInversion::rest(
    const PlantModel& nominal, const dynamics::EquationsOfMotion<double>& balance,
    const controllers::RestingCommand& command) const {
    dynamics::EquationsOfMotion<double> equations = balance;
    for (int i = 0; i < 4; ++i) {
        equations.bias[i] -= command.known_force[i];
    }
    const double thrust_n = command.wrench.thrust_n;
    const double force[3] = {0, thrust_n, command.wrench.pitch_torque_nm};
    const double torque_at_rest_nm = dynamics::joint_torque_for(nominal, equations, force, 0.0);
    const double torque_per_v7 = dynamics::joint_torque_for(nominal, equations, force, 1.0) - torque_at_rest_nm;
    const double v7 = (command.joint_torque_nm - torque_at_rest_nm) / torque_per_v7;
    const dynamics::RotationalSystem<double> s = dynamics::rotational_system(nominal, equations, force);
    const double v5 = (s.g5 - s.s57 * v7) / s.s55;
    const auto rate = controllers::settled_pid(v5, attitude_rate_kp, attitude_rate_ki, attitude_integral_limit_rad_s2);
    controllers::Rest<Memory> rest;
    rest.pitch_reference_rad = controllers::error_for(rate.error, attitude_kp);
    double sine = 0;
    double cosine = 1;
    lane::sin_cos(rest.pitch_reference_rad, sine, cosine);
    const double mass_kg = nominal.total_mass_kg;
    const double vx = (sine / cosine * thrust_n - nominal.arm_mass_kg * equations.arm_x * v7) / mass_kg;
    const double vz = (thrust_n - equations.bias[1] - nominal.arm_mass_kg * equations.arm_z * v7) / mass_kg;
    const auto x = controllers::settled_pid(vx, position_kp, position_ki, position_integral_limit_m_s2);
    const AxisGains height = axis_gains(1);
    const auto z = controllers::settled_pid(vz, height.kp, height.ki, position_integral_limit_m_s2);
    const auto arm = controllers::settled_pid(v7, arm_kp, arm_ki, arm_integral_limit_rad_s2);
    rest.error[0] = x.error;
    rest.error[1] = z.error;
    rest.error[2] = arm.error;
    rest.memory = {{x.integral, z.integral}, rate.integral, arm.integral, rest.pitch_reference_rad, 0, rate.error};
    rest.feeds_back = {{x.feeds_back, z.feeds_back}, rate.feeds_back, arm.feeds_back, true, true, rate_feed_forward};
    rest.height_gain_1_s2 = height.kp;
    rest.pitch_gain_1_s2 = attitude_kp * attitude_rate_kp;
    if (!(std::abs(rest.pitch_reference_rad) < max_tilt_rad)) {
        rest.limit = HoldLimit::tilt;
    } else if (!(thrust_n > min_vertical_force_ratio * nominal.weight_n)) {
        rest.limit = HoldLimit::vertical;
    } else if (!std::isfinite(x.error + z.error + arm.error)) {
        rest.limit = HoldLimit::gain;
    }
    return rest;
}

}  // namespace downwash
